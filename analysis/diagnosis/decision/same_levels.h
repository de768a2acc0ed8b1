#pragma once

#include <string_view>

#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// Whether the last effect of a fit, with one of another kind in its place that does the same to an axis that
/// slides, as large as the levels of the directions say, leaves what the blocks of the log do not tell apart
/// at the asked rate (Vuong, Econometrica 57, 1989).
bool SameLevels(const Problem& problem, const Fit& fit, std::string_view other, double rate);

}  // namespace contour::diagnosis
