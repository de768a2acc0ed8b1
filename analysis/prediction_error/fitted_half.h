#pragma once

#include <array>
#include <cstddef>

#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// Parts that a log is cut into, every other one for either half.
inline constexpr std::size_t kHalfParts = 8;
/// First row of a part; of the one behind the last, the end.
std::size_t PartBegin(const Problem& problem, std::size_t part);

/// The same model fitted to the even parts of the log alone, and to the odd ones.
std::array<Point, 2> FitHalves(const Problem& problem, const Fit& fit);

/// The base model alone, as the fit has it. Deviations: of the fit, or what it differs from half to half.
StatedAxis FittedAxis(const Problem& problem, const Fit& fit, const std::array<Point, 2>& halves);

}  // namespace contour::diagnosis
