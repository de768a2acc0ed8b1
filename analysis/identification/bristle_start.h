#pragma once

#include <vector>

#include "analysis/identification/measured.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// Stiffness of the bristle for the fit of all parameters to begin with. Shaking a sliding axis shows a bent
/// bristle as a spring with a relaxation, which what else swings may stand for, and from a bristle several
/// times too stiff the fit of the whole record does not come back. So: of a series about the axis's own and
/// of others (what reversals say, what is stated), the one with which the whole record is foreseen best.
double BristleToBeginWith_N_m(const TableAxis& axis, const std::vector<Measured>& records,
                              const std::vector<double>& others_N_m, int threads);

}  // namespace contour::identify
