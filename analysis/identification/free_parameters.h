#pragma once

#include <vector>

#include "analysis/identification/joint_fit.h"

namespace contour::identify {

/// What a fit moves, with its scale. `led_by_drive`: the record is of a drive that closes its own loop.
std::vector<FreeParameter> FreeParameters(const TableAxis& axis, bool led_by_drive,
                                          const FitOptions& options);

}  // namespace contour::identify
