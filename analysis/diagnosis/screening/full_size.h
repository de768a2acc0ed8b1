#pragma once

#include <limits>
#include <string>
#include <vector>

#include "analysis/diagnosis/screening/score.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// A grid point at full size, and what the cost would be there, the base following to first order.
struct GridPoint {
  Point point;
  double cost = std::numeric_limits<double>::infinity();
};

/// All grid points of a kind, in several sizes, at which the cost would be lower than the fit's.
/// Where the score test promises much, an excerpt of the log says first which of them are worth the whole.
std::vector<GridPoint> FullSize(const Problem& problem, const Fit& current, const std::string& kind,
                                const std::vector<Scored>& scored);

/// Of points next to a fit that have a cost: from an excerpt of the log, where that stands for the whole.
std::vector<GridPoint> RoughCosts(const Problem& problem, const Fit& around, std::vector<Point> points);

}  // namespace contour::diagnosis
