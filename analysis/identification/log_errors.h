#pragma once

#include <vector>

#include "analysis/identification/measured.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// Mean log of the prediction error that is left when each error is foreseen from those before it, of each
/// axis: the lower, the better does the axis foresee the records. Blocks of this length count alike, however
/// large their errors are. A tenth of a second counts no more than ten times the error that 95 % of
/// them stay below. What is no number is 1e300.
std::vector<double> LogErrors(const std::vector<TableAxis>& axes, const std::vector<Measured>& records,
                              double block_s, int threads);

}  // namespace contour::identify
