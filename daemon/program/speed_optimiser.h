#pragma once

#include <cstddef>

#include "daemon/program/speed_spline.h"
#include "daemon/program/stretch.h"

namespace contour {

/// What is asked of the speed along a stretch.
struct SpeedGoal {
  double feed_scale = 1.0;       ///< of programmed feeds; 0: to come to rest as soon as possible
  double floor = 0.0;            ///< square of the parameter's speed that is always within the limits
  bool feed_may_exceed = false;  ///< the feed was lowered on the way: it is met as soon as the limits allow
};

/// Largest square of a parameter's constant speed that keeps every limit from a node on, with room to spare.
double SafeFloor(const Stretch& stretch, const RestMap& map, const SpeedSpline& speed, const SpeedGoal& goal,
                 std::size_t first_node);

/// Raises the coefficients first..last of `speed` (or lowers them, for a lower feed) to the fastest motion
/// within the limits of velocity, acceleration and jerk of every axis, the others staying. They must keep the
/// limits before, and do after. With u the parameter, x an axis and w the square of u's speed,
///   velocity^2 = x'^2 w,  acceleration = x'' w + x' w' / 2,
///   jerk = sqrt(w) (x''' w + 3/2 x'' w' + 1/2 x' w''):
/// linear in w but for the root, and |x''' w + ...| <= jerk / sqrt(w) is linear once its right side, a convex
/// function, is replaced by its tangent, which is on the safe side. So an interior-point method with the
/// tangent at the present w finds the optimum without ever leaving the limits; it takes a few dozen steps,
/// each linear in the number of nodes.
void OptimiseSpeed(const Stretch& stretch, const RestMap& map, const SpeedGoal& goal, std::size_t first,
                   std::size_t last, SpeedSpline& speed);

}  // namespace contour
