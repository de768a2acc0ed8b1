#include "drivers/cia301/emergency_table.h"

#include <algorithm>
#include <array>

namespace contour {
namespace {

using enum EmergencyReaction;

struct Row {
  std::uint16_t code;
  EmergencyReaction reaction;
  std::string_view name;
};

// Error codes of CiA 301 and CiA 402. A code that is not listed is taken for its class: the same with the
// last digit zero, then with the last two, then with the last three. What is too hot or comes from outside
// leaves time to stop on the path; what takes current, voltage or set-points from the axis does not; by an
// encoder that the drive itself reports as faulty nothing can brake.
constexpr std::array kRows{
    Row{0x0000, kNone, "no error"},
    Row{0x1000, kStopOnPath, "generic error"},
    Row{0x2000, kQuickStop, "current"},
    Row{0x2300, kQuickStop, "current on the motor's side"},
    Row{0x2310, kQuickStop, "continuous over-current"},
    Row{0x2320, kQuickStop, "short circuit"},
    Row{0x2330, kQuickStop, "earth leakage"},
    Row{0x2350, kStopOnPath, "load level (I2t)"},
    Row{0x3000, kQuickStop, "voltage"},
    Row{0x3100, kQuickStop, "mains voltage"},
    Row{0x3130, kQuickStop, "phase of the mains missing"},
    Row{0x3210, kQuickStop, "DC link over-voltage"},
    Row{0x3220, kQuickStop, "DC link under-voltage"},
    Row{0x3300, kQuickStop, "output voltage"},
    Row{0x4000, kStopOnPath, "temperature"},
    Row{0x4100, kStopOnPath, "ambient temperature"},
    Row{0x4210, kStopOnPath, "excess temperature of the device"},
    Row{0x4310, kStopOnPath, "excess temperature of the drive"},
    Row{0x4400, kStopOnPath, "temperature of the supply"},
    Row{0x5000, kQuickStop, "device hardware"},
    Row{0x5100, kQuickStop, "supply of the device"},
    Row{0x5400, kQuickStop, "power section"},
    Row{0x5500, kStopOnPath, "data storage"},
    Row{0x6000, kQuickStop, "device software"},
    Row{0x6010, kQuickStop, "software reset (watchdog)"},
    Row{0x6100, kQuickStop, "internal software"},
    Row{0x6200, kStopOnPath, "user software"},
    Row{0x6300, kStopOnPath, "data record"},
    Row{0x6320, kStopOnPath, "parameter error"},
    Row{0x7000, kStopOnPath, "additional modules"},
    Row{0x7100, kQuickStop, "power: brake chopper, motor, brake"},
    Row{0x7120, kQuickStop, "motor"},
    Row{0x7121, kQuickStop, "motor blocked"},
    Row{0x7200, kQuickStop, "measurement circuit"},
    Row{0x7300, kVoltageOff, "sensor"},
    Row{0x7303, kVoltageOff, "resolver 1"},
    Row{0x7304, kVoltageOff, "resolver 2"},
    Row{0x7305, kVoltageOff, "incremental sensor 1"},
    Row{0x7306, kVoltageOff, "incremental sensor 2"},
    Row{0x7310, kVoltageOff, "speed measurement"},
    Row{0x7320, kVoltageOff, "position measurement"},
    Row{0x7400, kQuickStop, "computation circuit"},
    Row{0x7500, kStopOnPath, "communication"},
    Row{0x7600, kStopOnPath, "data storage outside"},
    Row{0x8000, kQuickStop, "monitoring"},
    Row{0x8100, kQuickStop, "communication"},
    Row{0x8110, kWarn, "CAN overrun, a message was lost"},
    Row{0x8120, kWarn, "CAN in error passive mode"},
    Row{0x8130, kQuickStop, "heartbeat of the master missing"},
    Row{0x8140, kQuickStop, "recovered from bus-off"},
    Row{0x8150, kQuickStop, "another node sends with this drive's identifier"},
    Row{0x8200, kQuickStop, "protocol error"},
    Row{0x8210, kQuickStop, "PDO not processed, its length is wrong"},
    Row{0x8220, kWarn, "PDO longer than expected"},
    Row{0x8240, kQuickStop, "SYNC of unexpected length"},
    Row{0x8250, kQuickStop, "RPDO timeout"},
    Row{0x8300, kQuickStop, "torque control"},
    Row{0x8400, kQuickStop, "velocity control"},
    Row{0x8500, kQuickStop, "position control"},
    Row{0x8611, kQuickStop, "following error"},
    Row{0x8612, kQuickStop, "reference limit"},
    Row{0x8700, kQuickStop, "SYNC missing or out of time"},
    Row{0x9000, kStopOnPath, "external error"},
    Row{0xF000, kStopOnPath, "additional functions"},
    Row{0xFF00, kStopOnPath, "specific to the device"},
};

const Row* Find(std::uint16_t error_code) noexcept {
  for (const std::uint16_t mask : std::array<std::uint16_t, 4>{0xFFFF, 0xFFF0, 0xFF00, 0xF000}) {
    const auto wanted = static_cast<std::uint16_t>(error_code & mask);
    if (error_code != 0 && wanted == 0) continue;
    for (const Row& row : kRows)
      if (row.code == wanted) return &row;
  }
  return nullptr;
}

// Bits of the error register (0x1001).
constexpr std::uint8_t kCurrentBit = 0x02;
constexpr std::uint8_t kVoltageBit = 0x04;
constexpr std::uint8_t kTemperatureBit = 0x08;

EmergencyReaction ReactionToRegister(std::uint8_t bits) noexcept {
  if ((bits & (kCurrentBit | kVoltageBit)) != 0) return kQuickStop;
  if ((bits & kTemperatureBit) != 0) return kStopOnPath;
  return kNone;  // generic, communication, profile and manufacturer bits: the code says more
}

}  // namespace

std::optional<EmergencyClass> ParseEmergencyClass(std::string_view key) noexcept {
  if (key.size() != 6 || key[0] != '0' || (key[1] != 'x' && key[1] != 'X')) return std::nullopt;
  EmergencyClass found{0, 0};
  bool any = false;
  for (const char c : key.substr(2)) {
    int digit = -1;
    if (c >= '0' && c <= '9') digit = c - '0';
    if (c >= 'a' && c <= 'f') digit = c - 'a' + 10;
    if (c >= 'A' && c <= 'F') digit = c - 'A' + 10;
    const bool every = c == 'x' || c == 'X';
    // Only the last digits may be left open, and not all of them.
    if ((!every && digit < 0) || (any && !every) || (every && found.mask == 0)) return std::nullopt;
    any = any || every;
    found.code = static_cast<std::uint16_t>((found.code << 4) | (every ? 0 : digit));
    found.mask = static_cast<std::uint16_t>((found.mask << 4) | (every ? 0 : 0xF));
  }
  if (found.code == 0) return std::nullopt;
  return found;
}

std::string_view EmergencyText(std::uint16_t error_code) noexcept {
  const Row* row = Find(error_code);
  return row == nullptr ? "unknown" : row->name;
}

EmergencyReaction ReactionTo(Emergency e) noexcept {
  if (e.error_code == 0) return kNone;
  const Row* row = Find(e.error_code);
  // A code of no class at all: an error, of which nothing is known.
  const EmergencyReaction by_code = row == nullptr ? kStopOnPath : row->reaction;
  return std::max(by_code, ReactionToRegister(e.error_register));
}

bool SaysMasterLost(std::uint16_t error_code) noexcept {
  return error_code == 0x8130 || error_code == 0x8140 || error_code == 0x8250 ||
         (error_code & 0xFF00) == 0x8700;
}

}  // namespace contour
