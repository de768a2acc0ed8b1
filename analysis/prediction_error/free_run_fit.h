#pragma once

#include <Eigen/Core>

#include "analysis/prediction_error/free_runs.h"
#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// The point from which free runs are off least in these parts, from a point on. Parameters stay within their
/// freedom about it (one standard deviation each; 0: held), and every window that does not overlap is one
/// datum: errors of a free run go together. The point itself where there is no window.
Point FitFreeRuns(const Problem& problem, const Point& from, const Eigen::VectorXd& freedom, Parts parts);

}  // namespace contour::diagnosis
