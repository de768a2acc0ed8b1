#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace contour {

/// Everything that may stop the machine because something looks wrong. Each can be switched off, by tests
/// alone, to show what it is good for: no key of a machine file does it. What is no number is never sent,
/// and an estimator that has diverged never used: those two have no switch.
enum class Watch : std::uint8_t {
  // The motion monitor.
  kFrozen,
  kJump,
  kMomentum,
  kDelivery,
  kScale,
  // The torque guard.
  kStaleFeedback,
  kVelocityLimit,
  kPositionLimit,
  kFollowingError,
  // Drives.
  kDriveFault,
  kDriveLeftEnabled,
  kDriveNotFollowing,
  kModeChanged,
  kDriveEmergency,
  kDriveLostMaster,
  kDriveRestarted,
  kDriveLeftOperational,
  kHeartbeatLost,
  // Buses.
  kBusDown,
  kSendFailed,
  kSecondMaster,
  // The cycle itself.
  kGridPointsSkipped,
  kSelfWatch,
};
inline constexpr std::size_t kWatchCount = static_cast<std::size_t>(Watch::kSelfWatch) + 1;

constexpr std::string_view Name(Watch w) noexcept {
  constexpr std::array<std::string_view, kWatchCount> kNames{"frozen",
                                                             "jump",
                                                             "momentum",
                                                             "delivery",
                                                             "scale",
                                                             "stale_feedback",
                                                             "velocity_limit",
                                                             "position_limit",
                                                             "following_error",
                                                             "drive_fault",
                                                             "left_enabled",
                                                             "not_following",
                                                             "mode_changed",
                                                             "emergency",
                                                             "lost_master",
                                                             "restarted",
                                                             "left_operational",
                                                             "heartbeat_lost",
                                                             "bus_down",
                                                             "send_failed",
                                                             "second_master",
                                                             "grid_points",
                                                             "self_watch"};
  return kNames[static_cast<std::size_t>(w)];
}

/// Those that are switched off; none, but in tests.
class WatchesOff {
 public:
  constexpr WatchesOff() noexcept = default;
  constexpr WatchesOff(std::initializer_list<Watch> off) noexcept {
    for (const Watch w : off) Add(w);
  }
  constexpr void Add(Watch w) noexcept { bits_ |= Bit(w); }
  constexpr void Add(WatchesOff other) noexcept { bits_ |= other.bits_; }
  constexpr bool operator==(const WatchesOff&) const noexcept = default;
  [[nodiscard]] constexpr bool Acts(Watch w) const noexcept { return (bits_ & Bit(w)) == 0; }

 private:
  static constexpr std::uint32_t Bit(Watch w) noexcept { return 1U << static_cast<unsigned>(w); }
  static_assert(kWatchCount <= 32);
  std::uint32_t bits_ = 0;
};

}  // namespace contour
