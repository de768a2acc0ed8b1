#pragma once

#include <vector>

#include "design/commission_plan.h"

namespace contour {

/// The excitation of DriveMotions repeats after this time.
inline constexpr double kDrivePeriod_s = 1.0;

/// Motions that show what a drive's own loop does, for an axis that stands at `position_mm` and a plan whose
/// limits and ends are known: strokes with ramps, and slow strokes on which a chirp is put on the torque
/// offset. The drive holds the axis throughout.
std::vector<CommissionMotion> DriveMotions(const CommissionPlan& plan, const AxisConfig& axis,
                                           double position_mm, double cycle_us);

}  // namespace contour
