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
  kPaused,
  kResuming,
  kFeedChange,
  kHalted,
};
inline constexpr std::array kPhases{
    Phase::kBringUp,  Phase::kIdle,       Phase::kEnabling, Phase::kReady, Phase::kAcceleration,
    Phase::kConstant, Phase::kReversal,   Phase::kStopping, Phase::kReset, Phase::kPaused,
    Phase::kResuming, Phase::kFeedChange, Phase::kHalted};

/// Of the programmed feed, after a change of feed.
inline constexpr double kLeastOfFeed = 0.1;
inline constexpr double kMostOfFeed = 0.7;

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
    case Phase::kPaused:
      return "paused";
    case Phase::kResuming:
      return "resuming";
    case Phase::kFeedChange:
      return "feed_change";
    case Phase::kHalted:
      return "halted";
  }
  return "unknown";
}

constexpr bool Moves(Phase p) noexcept {
  return p == Phase::kAcceleration || p == Phase::kConstant || p == Phase::kReversal ||
         p == Phase::kStopping || p == Phase::kResuming || p == Phase::kFeedChange;
}
/// The program's pace is or was another than the programmed one.
constexpr bool Paced(Phase p) noexcept {
  return p == Phase::kPaused || p == Phase::kResuming || p == Phase::kFeedChange || p == Phase::kHalted;
}
/// The machine holds the axes under torque.
constexpr bool Holds(Phase p) noexcept { return p == Phase::kReady || Moves(p) || Paced(p); }

}  // namespace contour::faults
