#pragma once

#include <vector>

#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// A model of a log, as its fit settled.
struct SettledModel {
  Problem& problem;                ///< holds the noise that was learnt there
  const std::vector<double>& raw;  ///< its prediction errors there (Fit)
};

/// [deviations] By which the first of two models of one log foresees it better than the second (Vuong,
/// Econometrica 57(2), 1989): the sum over the log of what their squared residuals differ by, over what that
/// sum scatters by from block to block, each as long as prediction errors remember. Under the noise of
/// either, since each is the better under a noise that was learnt of it alone: the lesser of the two counts,
/// and nothing where they do not agree.
double FirstIsBetterBy(const SettledModel& first, const SettledModel& second);

}  // namespace contour::diagnosis
