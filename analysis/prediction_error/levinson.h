#pragma once

#include <span>
#include <vector>

namespace contour::diagnosis {

/// The filter that leaves of a stationary signal what its past does not foretell.
struct ErrorFilter {
  std::vector<double> taps;  ///< the newest value first, whose tap is 1
  double left = 0.0;         ///< mean square of what is left, in the unit of the autocovariance
};

/// From the autocovariance at lags 0 to the order, by Levinson and Durbin. A little white noise (1e-9 of the
/// whole) keeps it from dividing by nothing.
ErrorFilter MakeErrorFilter(std::span<const double> autocovariance);

}  // namespace contour::diagnosis
