#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace contour::faults {

/// Where in the machine's life a fault begins.
enum class Phase : std::uint8_t {
  kBringUp,
  kIdle,
  kEnabling,
  kReady,
  kAcceleration,
  kConstant,
  kReversal,
  kStopping,
  kReset,
};
inline constexpr std::array kPhases{Phase::kBringUp,  Phase::kIdle,         Phase::kEnabling,
                                    Phase::kReady,    Phase::kAcceleration, Phase::kConstant,
                                    Phase::kReversal, Phase::kStopping,     Phase::kReset};

constexpr std::string_view Name(Phase phase) noexcept {
  switch (phase) {
    case Phase::kBringUp:
      return "bring_up";
    case Phase::kIdle:
      return "idle";
    case Phase::kEnabling:
      return "enabling";
    case Phase::kReady:
      return "ready";
    case Phase::kAcceleration:
      return "acceleration";
    case Phase::kConstant:
      return "constant";
    case Phase::kReversal:
      return "reversal";
    case Phase::kStopping:
      return "stopping";
    case Phase::kReset:
      return "reset";
  }
  return "unknown";
}

constexpr bool Moves(Phase p) noexcept {
  return p == Phase::kAcceleration || p == Phase::kConstant || p == Phase::kReversal || p == Phase::kStopping;
}
/// The machine holds the axes under torque.
constexpr bool Holds(Phase p) noexcept { return p == Phase::kReady || Moves(p); }

}  // namespace contour::faults
