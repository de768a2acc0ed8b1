#pragma once

#include <algorithm>
#include <cmath>

// A stop on the path: the fixed ramp, and how much longer one within the axes' limits may take, in parts of
// its length: what the cycle keeps and what contour check promises.
namespace contour::stop_on_path {

/// The fixed ramp of the pace, 1 - (3 s^2 - 2 s^3), has a steepest slope of 1.5 / T and a sharpest bend of
/// 6 / T^2. With this T an axis at its highest speed just keeps its limits. Speed, acceleration and jerk in
/// one unit of length, and seconds.
inline double RampTime_s(double velocity, double acceleration, double jerk) noexcept {
  return std::max(1.5 * velocity / acceleration, std::sqrt(6.0 * velocity / jerk));
}

/// From its first point to rest.
inline constexpr double kLongest = 2.0;
/// Time on the path that goes by meanwhile; of the fixed ramp it is a half.
inline constexpr double kFarthest = 1.0;
/// The motion goes on for so long while the stop is looked for.
inline constexpr double kSearches = 0.5;

}  // namespace contour::stop_on_path
