#pragma once

#include <string>
#include <vector>

#include "tools/validation/emps/free_run.h"

namespace contour::emps {

/// A number of Parameters that is fitted, and its size.
struct Free {
  double Parameters::*value;
  double scale;
};

/// Fits the free parameters so that free runs of `window` rows, started every quarter of a second from the
/// filtered measurement, miss the raw position least (Levenberg and Marquardt, differences of runs). The sum
/// of squares is over every 20th row.
Parameters FitFreeRun(Parameters start, const std::vector<Free>& free, const Recording& r,
                      const Segment& segment, std::size_t window);

}  // namespace contour::emps
