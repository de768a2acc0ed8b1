#pragma once

// How much longer a stop on the path within the axes' limits may take than the fixed ramp, in parts of its
// length: what the cycle keeps and what contour check promises.
namespace contour::stop_on_path {

/// From its first point to rest.
inline constexpr double kLongest = 2.0;
/// Time on the path that goes by meanwhile; of the fixed ramp it is a half.
inline constexpr double kFarthest = 1.0;
/// The motion goes on for so long while the stop is looked for.
inline constexpr double kSearches = 0.5;

}  // namespace contour::stop_on_path
