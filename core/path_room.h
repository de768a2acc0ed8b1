#pragma once

#include <cstddef>

namespace contour {

/// Points of the path that the cycle keeps (daemon/rt/path_follower).
inline constexpr std::size_t kPathCapacity = 1024;

/// Longest fixed ramp to rest, in periods: the half of it that is path, what the controller looks ahead by,
/// and some points that are handed over meanwhile find room in them.
constexpr double MostRamp_periods(std::size_t horizon) {
  return 2.0 * (static_cast<double>(kPathCapacity - horizon) - 16.0);
}

}  // namespace contour
