#pragma once

#include <algorithm>

namespace contour {

/// What learns or filters on line by shares of an error states them per millisecond, as the filters state
/// their noise, and takes as much of it per cycle as a cycle is long; never more than the whole error. For
/// short cycles that is a time constant of 1 ms / share (off by half a share: 2.5 % of 0.1 at 2 kHz).
inline double ShareOfPeriod(double per_millisecond, double period_s) noexcept {
  return std::min(per_millisecond * (period_s / 1e-3), 1.0);
}

}  // namespace contour
