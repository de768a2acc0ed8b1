#pragma once

#include <vector>

#include "analysis/diagnosis/decision/guesses.h"

namespace contour::diagnosis {

/// Where a cause explains most of the force that a sliding axis needs beyond the base, by least squares, the
/// base fitted without it may lie far off, and what it lacks passes for noise there: from the numbers that
/// least squares have with each such cause. Those that explain the most, at most as many as are fitted in one
/// turn.
std::vector<InitialGuess> FromLeastSquares(const Problem& problem, const Fit& current,
                                           const std::vector<Scored>& scored);

}  // namespace contour::diagnosis
