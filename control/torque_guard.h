#pragma once

#include <cstddef>
#include <cstdint>

#include "control/control_config.h"
#include "core/axis.h"
#include "core/reason.h"
#include "core/watch.h"

namespace contour {

/// One axis as the guard knows it.
struct GuardedAxis {
  AxisLimitsSi limits;
  double radius_m_rad = 0.0;
};

/// What the guard says of one axis in one cycle.
struct GuardedTorque {
  double torque_Nm = 0.0;        ///< to be sent; 0 with a fault
  Reason limit = Reason::kNone;  ///< kTorqueLimit or kTorqueRateLimit when the wanted torque was held back
  Reason fault =
      Reason::kNone;  ///< kNotANumber, kStaleFeedback, kPositionLimit, kVelocityLimit, kFollowingError
};

/// The last word on torque, per axis. Whatever the controllers ask for, what leaves here is finite, within
/// the torque limit and, without a fault, within the rate limit. A fault gives zero torque at once, past the
/// rate limit.
///
/// While an axis is not enabled the torque is zero and nothing is a fault but numbers that are none.
class TorqueGuard {
 public:
  TorqueGuard(const GuardConfig& config, const PerAxis<GuardedAxis>& axes, double period_s,
              WatchesOff off = {});

  /// Forgets the last torque and position of every axis.
  void Reset() noexcept;

  /// Until the next Reset the axis has no limits of position but these: so far to either side of where it is
  /// when it is enabled next. For an axis that does not know where it is.
  void Confine(std::size_t axis, double travel_m) noexcept { memory_[axis].confined_to_m = travel_m; }
  [[nodiscard]] double allowed_min_m(std::size_t axis) const noexcept { return memory_[axis].allowed_min_m; }
  [[nodiscard]] double allowed_max_m(std::size_t axis) const noexcept { return memory_[axis].allowed_max_m; }

  /// So many periods go by until the drives latch the next position, beyond the usual one.
  void Skip(std::uint32_t periods) noexcept;

  /// To be called once per axis and cycle. `reference_position_m` is the reference at the feedback's instant,
  /// which is further than a period behind the one before by `sync_apart_s`, where that is known.
  GuardedTorque Limit(std::size_t axis, double wanted_torque_Nm, const AxisFeedback& feedback,
                      double reference_position_m, bool enabled, double sync_apart_s = 0.0) noexcept;

 private:
  struct Memory {
    double torque_Nm = 0.0;
    double position_m = 0.0;
    std::uint32_t cycles_since_position = 0;
    bool has_position = false;
    bool was_enabled = false;
    double allowed_min_m = 0.0;  ///< position limits of this enabling
    double allowed_max_m = 0.0;
    double confined_to_m = 0.0;  ///< 0: to the axis's own limits
  };
  Reason FindFault(std::size_t axis, double wanted_torque_Nm, const AxisFeedback& feedback,
                   double reference_position_m, bool enabled, double sync_apart_s) noexcept;

  GuardConfig config_;
  WatchesOff off_;
  PerAxis<GuardedAxis> axes_;
  PerAxis<Memory> memory_;
  double period_s_;
};

}  // namespace contour
