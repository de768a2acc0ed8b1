#pragma once

#include <limits>

namespace contour::diagnosis {

/// How far a fit goes.
struct FitEffort {
  /// [steps] Where nothing else is said. Source: time. 2026-11-21
  int most_steps = 8;
  /// [renewals of the sensitivities] Where nothing else is said. Source: time. 2026-11-21
  int most_refreshes = 8;
  /// [chi^2] What one more step would promise at an end, where nothing else is said. Source: reasoning; moves
  /// no size by a seventh of its deviation. 2026-11-21
  double close_enough = 0.02;
  bool covariance = true;  ///< of the end point; else sensitivities may be old
  /// So much of what the cost has fallen below `from` is close enough, too.
  double share_enough = 0.0, from = 0.0;
  /// Given up where not even the first step's promise leads below.
  double hopeless_above = std::numeric_limits<double>::infinity();
};

}  // namespace contour::diagnosis
