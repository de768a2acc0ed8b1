#pragma once

#include <cstddef>

#include "core/horizon.h"

namespace contour {

/// Points of the path that the cycle keeps (daemon/rt/path_follower).
inline constexpr std::size_t kPathPoints = 1024;

/// Of the fixed ramp to rest, in periods: the half of it that is path, what the controller looks ahead by,
/// and some must find room in them.
inline constexpr double kMostRamp_periods = 2.0 * (kPathPoints - kMaxHorizonPoints - 16.0);

}  // namespace contour
