#pragma once

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// Adds to a cause's intervals what the fit's scatter does not know: that no effect acts quite as its model
/// does, and what only the priors say of a torque constant.
void WidenIntervals(const Problem& problem, const Point& point, Cause& cause);

}  // namespace contour::diagnosis
