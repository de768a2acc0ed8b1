#pragma once

#include <vector>

#include "design/commission_plan.h"

namespace contour {

/// Force of the chirp at the table: a share of the rated one, which a catalogue states exactly.
double CommissionChirp_N(const AxisConfig& axis);
/// Less room than this on one side is none.
inline constexpr double kLeastCommissionStroke_mm = 1.0;

/// The motions of a plan whose limits and ends are known, from the slowest on, for an axis that stands at
/// `position_mm`.
std::vector<CommissionMotion> CommissionMotions(const CommissionPlan& plan, const AxisConfig& axis,
                                                double position_mm, double cycle_us);

}  // namespace contour
