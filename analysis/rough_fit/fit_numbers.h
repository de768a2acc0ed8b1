#pragma once

#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/prediction_error/fit.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// The numbers of a model from a log, by prediction errors; what the file states is where the fit begins and
/// nothing more.
struct FittedNumbers {
  StatedAxis axis;       ///< with deviations
  std::string unusable;  ///< why nothing of it may be used, and what to do; empty: it may
  std::vector<std::string> notes;
};

/// Of any axis, whatever its units. The log may be several, joined. Throws ConfigError where what the file
/// leaves open is not in the log.
FittedNumbers FitNumbers(AxisLog log, StatedAxis stated, int threads);

}  // namespace contour::diagnosis
