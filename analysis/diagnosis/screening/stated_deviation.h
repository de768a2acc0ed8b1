#pragma once

#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// Of the numbers of the model that the last effect of a fit frees: chi^2 of their distance from what is
/// stated, where the log alone puts them. Chance is what their stated uncertainty and the log leave open
/// together, and of the log the scatter of its blocks.
double StatedDeviation(const Problem& problem, const Fit& fit);

}  // namespace contour::diagnosis
