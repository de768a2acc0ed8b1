#include "tools/faults/injection.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "drivers/cia301/messages.h"
#include "drivers/cia402/pdo_layout.h"
#include "tools/faults/fault_bounds.h"
#include "tools/faults/machine_tamper.h"

namespace contour::faults {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;
constexpr std::uint16_t kHighestPriorityUnused = 0x001;  ///< CANopen has nothing there
constexpr std::uint16_t kTrafficId = 0x4FE;              ///< fourth TPDO of node 126: behind ours in priority
constexpr int kBurstFrames = 8;
constexpr double kBitsOfLongFrame = 105.0;
constexpr int kLateCycles = 5;
/// Of rated torque: what the other master asks for.
constexpr std::int16_t kForeignTorque_per_mille = 100;
constexpr std::uint16_t kEnableOperation = 0x000F;
constexpr std::size_t kQueueEntries = 16;

CanFrame FloodFrame() {
  CanFrame f{kHighestPriorityUnused, 8, {}};
  f.data.fill(0x55);
  return f;
}

}  // namespace

Injection::Injection(const FaultCase& c, const MachineConfig& machine, plant::Random& random)
    : c_(c),
      config_(machine),
      axis_(std::next(machine.axes.begin(), static_cast<std::ptrdiff_t>(c.axis))->second),
      drive_(axis_.drive),
      bus_(BusIndex(machine, axis_.drive.bus)),
      random_(random) {
  for (std::size_t b = 0; b < machine.buses.size(); ++b) intruders_.push_back(std::make_unique<Intruder>());
  if (c.fault == Fault::kLogBlocked) queue_ = std::make_unique<TelemetryQueue>(kQueueEntries);
}

Surroundings Injection::surroundings() {
  Surroundings s;
  for (const auto& i : intruders_) s.nodes.push_back({i.get()});
  s.wrap = [this](std::size_t, LoopbackBus& inner) {
    buses_.push_back(std::make_unique<MeddlingBus>(inner));
    return buses_.back().get();
  };
  s.prompt = true;
  return s;
}

int Injection::Draw(int from, int to) {
  return std::min(to, from + static_cast<int>(random_.Uniform() * (to - from + 1)));
}

double Injection::CountsPerMm() const {
  return static_cast<double>(drive_.encoder_counts_per_rev) / axis_.model.mechanics.lead_mm;
}

void Injection::AfterCycle(const CycleEntry& entry) {
  if (c_.fault == Fault::kCyclesLate) machine_->TellLate(broken_);
  if (!queue_) return;
  *queue_->Reserve() = entry;
  queue_->Publish();
  if (!broken_)
    while (queue_->Front() != nullptr) queue_->Release();
}

void Injection::Break() {
  broken_ = true;
  plant::EmulatedAxis& axis = MachineTamper::Axis(machine_->emulated(), c_.axis);
  BreakBus();
  Intrude();
  BreakDrive(axis);
  BreakEncoder(axis);
  BreakScale(axis.scale_tampering());
}

void Injection::BreakBus() {
  using What = Meddling::What;
  const std::uint16_t answer = Id(cob::kTpdo1);
  const std::uint16_t setpoint = Id(cob::kRpdo1);
  switch (c_.fault) {
    case Fault::kFeedbackFrameLost:
      return BreakFrames({What::kDrop, answer, 1});
    case Fault::kFeedbackFramesLost:
      return BreakFrames({What::kDrop, answer});
    case Fault::kFeedbackFrameLate:
      return BreakFrames({What::kDelay, answer, 1});
    case Fault::kFeedbackFramesLate:
      return BreakFrames({What::kDelay, answer, -1, kLateCycles});
    case Fault::kFeedbackFrameTwice:
      return BreakFrames({What::kDouble, answer, 1});
    case Fault::kPositionBitLow:
      return BreakFrames({What::kFlip, answer, 1, 1, 2, Draw(0, 2)});
    case Fault::kPositionBitHigh: {
      const int bit = Draw(8, 31);
      return BreakFrames({What::kFlip, answer, 1, 1, 2 + bit / 8, bit % 8});
    }
    case Fault::kPositionBitTop:
      return BreakFrames({What::kFlip, answer, 1, 1, 5, 6});
    case Fault::kStatusBitEnabled:
      return BreakFrames({What::kFlip, answer, 1, 1, 0, 2});
    case Fault::kStatusBitFault:
      return BreakFrames({What::kFlip, answer, 1, 1, 0, 3});
    case Fault::kSetpointLost:
      return BreakFrames({What::kDrop, setpoint, 1});
    case Fault::kSetpointsLost:
      return BreakFrames({What::kDrop, setpoint});
    case Fault::kScaleSilent:
      return BreakFrames({What::kDrop, Id(cob::kTpdo1 + 0x100)});
    case Fault::kHeartbeatsLost:
      return BreakFrames({What::kDrop, Id(cob::kHeartbeat)});
    case Fault::kBusDown:
      return machine_->bus(bus_).SetLink(now_ns(), false);
    case Fault::kGridPointsSkipped:
      return machine_->SkipGridPoints(static_cast<std::uint64_t>(config_.control.guard.stale_cycles));
    default:
      return;
  }
}

void Injection::Flood(bool forever) {
  const auto bitrate = static_cast<double>(
      std::next(config_.buses.begin(), static_cast<std::ptrdiff_t>(bus_))->second.bitrate_bit_s);
  const auto period_ns = static_cast<std::int64_t>(1e9 * kBitsOfLongFrame / bitrate);
  intruders_[bus_]->Begin(FloodFrame(), period_ns, forever ? -1 : kBurstFrames);
}

void Injection::Intrude() {
  Intruder& intruder = *intruders_[bus_];
  intruder.SetTime(now_ns());
  const auto node = static_cast<std::uint8_t>(drive_.node_id);
  const std::int64_t period_ns = 1000LL * config_.machine.cycle_us;
  const auto somewhen_ns = static_cast<std::int64_t>(random_.Uniform() * static_cast<double>(period_ns));
  switch (c_.fault) {
    case Fault::kFloodBurst:
      return Flood(false);
    case Fault::kFlood:
      return Flood(true);
    case Fault::kForeignReset:
      return intruder.Begin(NmtFrame(NmtCommand::kResetNode, node), period_ns, 1, somewhen_ns);
    case Fault::kForeignSync:
      return intruder.Begin(CanFrame{cob::kSync, 0, {}}, period_ns, -1, somewhen_ns);
    case Fault::kForeignNmt:
      return intruder.Begin(NmtFrame(NmtCommand::kStart, 0), 10 * kMs_ns, 3, somewhen_ns);
    case Fault::kForeignSetpoint: {
      const std::int32_t here = static_cast<std::int32_t>(
          std::llround(machine_->record().axes[c_.axis].feedback.position_rad / 6.283185307179586 *
                       static_cast<double>(drive_.encoder_counts_per_rev)));
      const CanFrame f = c_.mode == DriveMode::kCst
                             ? EncodeTorqueSetpoint(node, kEnableOperation, kForeignTorque_per_mille)
                             : EncodePositionSetpoint(node, kEnableOperation, here, drive_.csp_torque_offset,
                                                      kForeignTorque_per_mille);
      return intruder.Begin(f, period_ns, -1, somewhen_ns);
    }
    case Fault::kForeignHeartbeat: {
      const int master =
          std::next(config_.buses.begin(), static_cast<std::ptrdiff_t>(bus_))->second.master_node_id;
      return intruder.Begin(HeartbeatFrame(static_cast<std::uint8_t>(master), NmtState::kOperational),
                            10 * kMs_ns, -1, somewhen_ns);
    }
    case Fault::kBusTraffic: {
      // Of nobody's here, so that every SYNC meets them at another instant.
      CanFrame f{kTrafficId, 8, {}};
      f.data = {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55};
      const double some_ns = static_cast<double>(period_ns) * random_.Uniform(1.15, 1.85);
      return intruder.Begin(f, static_cast<std::int64_t>(some_ns), -1, somewhen_ns);
    }
    case Fault::kForeignSdo: {
      CanFrame f{Id(cob::kSdoRequest), 8, {}};
      f.data = {0x40, 0x18, 0x10, 0x01};  // reads 0x1018:01
      return intruder.Begin(f, 20 * kMs_ns, -1, somewhen_ns);
    }
    default:
      return;
  }
}

void Injection::BreakDrive(plant::EmulatedAxis& axis) {
  switch (c_.fault) {
    case Fault::kDriveRestarts:
      return axis.Restart(now_ns());
    case Fault::kDriveLeavesOperational:
      return axis.LeaveOperational();
    case Fault::kDriveDropsOut:
      return axis.DropOut();
    case Fault::kDriveWrongMode:
      return axis.ChangeMode(1);  // profile position
    case Fault::kDriveFault:
      return axis.InjectFault(0x3210);
    case Fault::kEmergencyTemperature:
      return axis.SendEmergency(0x4210, 0x08);
    case Fault::kEmergencyCurrent:
      return axis.SendEmergency(0x2310, 0x02);
    case Fault::kEmergencyVoltage:
      return axis.SendEmergency(0x3210, 0x04);
    case Fault::kEmergencyEncoder:
      return axis.SendEmergency(0x7305, 0x20);
    case Fault::kEmergencyLostMaster:
      return axis.SendEmergency(0x8130, 0x10);
    case Fault::kEmergencyExternal:
      return axis.SendEmergency(0x9000, 0x00);
    case Fault::kEmergencyMaker:
      return axis.SendEmergency(0xFF01, 0x80);
    case Fault::kEmergencyCleared:
      return axis.SendEmergency(0x0000, 0x00);
    default:
      return;
  }
}

void Injection::BreakEncoder(plant::EmulatedAxis& axis) {
  plant::Tampering& t = axis.tampering();
  const int sign = Draw(0, 1) == 0 ? -1 : 1;
  switch (c_.fault) {
    case Fault::kEncoderReversed:
      return t.Scale(-1.0);
    case Fault::kEncoderCountsLess:
      return t.Scale(1.0 - kCountsMissing_rel);
    case Fault::kEncoderJumpTiny:
      return t.Jump(sign * Draw(1, 3));
    case Fault::kEncoderJump:
    case Fault::kEncoderJumpLarge:
      return t.Jump(sign * std::llround(JumpSize_mm(config_, c_) * CountsPerMm()));
    case Fault::kEncoderFrozen:
      return t.Freeze();
    case Fault::kEncoderFlickers:
      return t.Freeze(1);
    case Fault::kTorqueLost:
      return t.WeakenTorque(0.0, true);
    case Fault::kTorqueLostSilently:
      return t.WeakenTorque(0.0, false);
    case Fault::kTorqueHalved:
      return t.WeakenTorque(0.5, false);
    default:
      return;
  }
}

void Injection::BreakScale(plant::Tampering& t) {
  switch (c_.fault) {
    case Fault::kScaleFrozen:
      return t.Freeze();
    case Fault::kScaleReversed:
      return t.Scale(-1.0);
    case Fault::kScaleCountsLess:
      return t.Scale(1.0 - kCountsMissing_rel);
    case Fault::kScaleJump:
      if (drive_.linear_scale)
        t.Jump(std::llround(JumpSize_mm(config_, c_) * drive_.linear_scale->counts_per_mm));
      return;
    default:
      return;
  }
}

void Injection::Mend() {
  broken_ = false;
  for (auto& b : buses_) b->End();
  for (auto& i : intruders_) i->End();
  plant::EmulatedAxis& axis = MachineTamper::Axis(machine_->emulated(), c_.axis);
  axis.tampering().MendEncoder();
  axis.scale_tampering().MendEncoder();
  axis.tampering().MendTorque();
  if (c_.fault == Fault::kDriveWrongMode) axis.ChangeMode(c_.mode == DriveMode::kCst ? 10 : 8);
  if (c_.fault == Fault::kBusDown) machine_->bus(bus_).SetLink(now_ns(), true);
}

}  // namespace contour::faults
