#include "tools/plant_emulator/drive_objects.h"

#include <algorithm>
#include <cmath>

#include "tools/plant_emulator/canopen_slave.h"

namespace contour::plant {
namespace {

using enum ObjectType;
using enum ObjectAccess;
using enum ObjectMapping;

constexpr std::int64_t kMaxU32 = 4294967295;

void AddStateMachine(ObjectDictionary& o) {
  o.Add(0x6007, 0, kI16, kReadWrite, 1);
  o.Limit(0x6007, 0, 0, 3);
  o.Add(0x603F, 0, kU16, kReadOnly, 0, kTpdo);
  o.Add(0x6040, 0, kU16, kReadWrite, 0, kRpdo);
  o.Add(0x6041, 0, kU16, kReadOnly, 0, kTpdo);
  o.Add(0x605A, 0, kI16, kReadWrite, 2);
  o.Add(0x605B, 0, kI16, kReadWrite, 0);
  o.Limit(0x605B, 0, 0, 1);
  o.Add(0x605C, 0, kI16, kReadWrite, 1);
  o.Limit(0x605C, 0, 0, 1);
  o.Add(0x605D, 0, kI16, kReadWrite, 1);
  o.Limit(0x605D, 0, 1, 1);
  o.Add(0x605E, 0, kI16, kReadWrite, 2);
  o.Limit(0x605E, 0, 0, 2);
}

void AddModes(ObjectDictionary& o, const AxisParameters& p) {
  o.Add(0x6060, 0, kI8, kReadWrite, 0, kRpdo);
  o.Add(0x6061, 0, kI8, kReadOnly, 0, kTpdo);
  o.Add(0x60C2, 0, kU8, kReadOnly, 2);
  o.Add(0x60C2, 1, kU8, kReadWrite, 1);
  o.Add(0x60C2, 2, kI8, kReadWrite, -3);
  o.Limit(0x60C2, 2, -6, 0);
  o.Add(0x6502, 0, kU32, kReadOnly,
        (p.csp_mode ? 1 << (kModeCsp - 1) : 0) | (p.torque_mode ? 1 << (kModeCst - 1) : 0));
}

void AddPosition(ObjectDictionary& o, const AxisParameters& p, double counts_per_rad) {
  const double counts_per_m = counts_per_rad / p.radius_m_rad;
  const auto acceleration = [&](double m_s2) {
    return std::clamp<std::int64_t>(std::llround(m_s2 * counts_per_m), 1, kMaxU32);
  };
  o.Add(0x6064, 0, kI32, kReadOnly, 0, kTpdo);
  o.Add(0x6065, 0, kU32, kReadWrite, kMaxU32);
  o.Add(0x6066, 0, kU16, kReadWrite, 0);
  o.Add(0x606C, 0, kI32, kReadOnly, 0, kTpdo);
  o.Add(0x607A, 0, kI32, kReadWrite, 0, kRpdo);
  o.Add(0x607E, 0, kU8, kReadWrite, 0);
  o.Limit(0x607E, 0, 0, 0);  // this drive cannot turn its axis round
  o.Add(0x6084, 0, kU32, kReadWrite, acceleration(2.0));
  o.Limit(0x6084, 0, 1, kMaxU32);
  o.Add(0x6085, 0, kU32, kReadWrite, acceleration(5.0));
  o.Limit(0x6085, 0, 1, kMaxU32);
  o.Add(0x608F, 0, kU8, kReadOnly, 2);
  o.Add(0x608F, 1, kU32, kReadOnly, std::llround(p.encoder_counts_per_rev));
  o.Add(0x608F, 2, kU32, kReadOnly, 1);
  o.Add(0x6091, 0, kU8, kReadOnly, 2);
  o.Add(0x6091, 1, kU32, kReadOnly, 1);
  o.Add(0x6091, 2, kU32, kReadOnly, 1);
  o.Add(0x60B1, 0, kI32, kReadWrite, 0, kRpdo);
  if (p.scale_counts_per_m > 0.0) {
    o.Add(0x60E4, 0, kU8, kReadOnly, 1);
    o.Add(0x60E4, 1, kI32, kReadOnly, 0, kTpdo);
  }
  o.Add(0x60F4, 0, kI32, kReadOnly, 0, kTpdo);
}

void AddTorque(ObjectDictionary& o, const AxisParameters& p) {
  const auto peak =
      std::min<std::int64_t>(32767, std::llround(1000.0 * p.peak_torque_Nm / p.rated_torque_Nm));
  o.Add(0x6071, 0, kI16, kReadWrite, 0, kRpdo);
  o.Add(0x6072, 0, kU16, kReadWrite, peak, kRpdo);
  o.Limit(0x6072, 0, 0, peak);
  o.Add(0x6074, 0, kI16, kReadOnly, 0, kTpdo);
  o.Add(0x6076, 0, kU32, kReadOnly, std::llround(1000.0 * p.rated_torque_Nm));
  o.Add(0x6077, 0, kI16, kReadOnly, 0, kTpdo);
  o.Add(0x60B2, 0, kI16, kReadWrite, 0, kRpdo);
  o.Add(0x60E0, 0, kU16, kReadWrite, peak, kRpdo);
  o.Limit(0x60E0, 0, 0, peak);
  o.Add(0x60E1, 0, kU16, kReadWrite, peak, kRpdo);
  o.Limit(0x60E1, 0, 0, peak);
}

ObjectDictionary Filled(const AxisParameters& p, const EmulatedAxisPlacement& placement,
                        double counts_per_rad) {
  ObjectDictionary o;
  CanopenSlave::AddObjects(
      o, placement.node_id,
      {placement.vendor_id, placement.product_code, placement.revision, placement.serial});
  AddStateMachine(o);
  AddModes(o, p);
  AddPosition(o, p, counts_per_rad);
  AddTorque(o, p);
  o.Seal();
  return o;
}

}  // namespace

DriveObjects::DriveObjects(const AxisParameters& parameters, const EmulatedAxisPlacement& placement,
                           double counts_per_rad)
    : dictionary(Filled(parameters, placement, counts_per_rad)) {}

}  // namespace contour::plant
