#pragma once

#include "daemon/program/motion_plan.h"

namespace contour {

/// From one speed down to another by a share of the axes' limits of acceleration and jerk, whichever way the
/// path goes: jerk first one way, then the other.
class SafeSlowing {
 public:
  /// From the root of `square_from` to that of `square_to`, which is lower.
  SafeSlowing(const PerAxis<PlanLimits>& limits, double share, double square_to, double square_from);

  /// That it takes.
  [[nodiscard]] double way() const { return 0.5 * (slow_ + fast_) * duration_s_; }
  /// Square of the speed at a way before its end.
  [[nodiscard]] double SquareBefore(double way) const;

 private:
  double slow_, fast_;
  double jerk_ = 0.0;
  double duration_s_ = 0.0;
};

}  // namespace contour
