#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/cia301/messages.h"

namespace contour {

/// What an emergency message of an enabled drive leads to, the weakest first.
enum class EmergencyReaction : std::uint8_t {
  kNone = 0,        ///< no error, or taken back
  kWarn = 1,        ///< said, and nothing else
  kStopOnPath = 2,  ///< there is time: the machine stops on the path, then it is Faulted
  kQuickStop = 3,
  kVoltageOff = 4,  ///< the drive cannot brake by an encoder that cannot be believed
};

constexpr std::string_view Name(EmergencyReaction r) noexcept {
  switch (r) {
    case EmergencyReaction::kNone:
      return "none";
    case EmergencyReaction::kWarn:
      return "warn";
    case EmergencyReaction::kStopOnPath:
      return "stop_on_path";
    case EmergencyReaction::kQuickStop:
      return "quick_stop";
    case EmergencyReaction::kVoltageOff:
      return "voltage_off";
  }
  return "unknown";
}
constexpr std::string_view Choices(EmergencyReaction) noexcept {
  return "warn, stop_on_path, quick_stop, voltage_off";
}
constexpr bool FromName(std::string_view name, EmergencyReaction& reaction) noexcept {
  for (const EmergencyReaction r : {EmergencyReaction::kWarn, EmergencyReaction::kStopOnPath,
                                    EmergencyReaction::kQuickStop, EmergencyReaction::kVoltageOff}) {
    if (Name(r) != name) continue;
    reaction = r;
    return true;
  }
  return false;
}

/// A code, or a class of them: those whose bits under the mask are these.
struct EmergencyClass {
  std::uint16_t code = 0;
  std::uint16_t mask = 0xFFFF;
  [[nodiscard]] constexpr bool Holds(std::uint16_t error_code) const noexcept {
    return (error_code & mask) == code;
  }
};

/// Reads a key of the machine file: "0x4210" for one code, "0x42xx" or "0x4xxx" for a class.
[[nodiscard]] std::optional<EmergencyClass> ParseEmergencyClass(std::string_view key) noexcept;

/// What an emergency error code (CiA 301 and CiA 402) stands for; its class when the code itself is a
/// manufacturer's.
[[nodiscard]] std::string_view EmergencyText(std::uint16_t error_code) noexcept;

/// The least that an emergency message leads to: by its code, and by what else the error register says.
[[nodiscard]] EmergencyReaction ReactionTo(Emergency emergency) noexcept;

/// The drive says that it lost the master: no heartbeat, no set-points, no SYNC, or back from bus-off.
[[nodiscard]] bool SaysMasterLost(std::uint16_t error_code) noexcept;

}  // namespace contour
