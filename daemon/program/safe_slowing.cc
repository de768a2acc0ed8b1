#include "daemon/program/safe_slowing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/program/bisection.h"

namespace contour {

SafeSlowing::SafeSlowing(const PerAxis<PlanLimits>& limits, double share, double square_to,
                         double square_from)
    : slow_(std::sqrt(square_to)), fast_(std::sqrt(square_from)) {
  double acceleration = std::numeric_limits<double>::infinity();
  jerk_ = acceleration;
  for (const PlanLimits& l : limits) {
    acceleration = std::min(acceleration, share * l.acceleration_m_s2);
    jerk_ = std::min(jerk_, share * l.jerk_m_s3);
  }
  const double change = fast_ - slow_;
  if (!(change > 0.0)) return;
  jerk_ = std::min(jerk_, acceleration * acceleration / change);
  duration_s_ = 2.0 * std::sqrt(change / jerk_);
}

double SafeSlowing::SquareBefore(double way_m) const {
  if (way_m <= 0.0) return slow_ * slow_;
  if (way_m >= way()) return fast_ * fast_;
  // Backwards in time from the end; both halves are alike but for the speed that they begin with.
  const double half_s = 0.5 * duration_s_;
  const double half_m = half_s * (slow_ + jerk_ * half_s * half_s / 6.0);
  const bool late = way_m < half_m;
  const double from = late ? slow_ : fast_, jerk = late ? jerk_ : -jerk_;
  const double left_m = late ? way_m : way() - way_m;
  const double t =
      LargestThat([&](double s) { return s * (from + jerk * s * s / 6.0) <= left_m; }, 0.0, half_s);
  const double speed = from + 0.5 * jerk * t * t;
  return speed * speed;
}

}  // namespace contour
