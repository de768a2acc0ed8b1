#pragma once

#include <string>
#include <vector>

#include "design/commission_plan.h"

namespace contour {

/// Strokes and speeds stay this far inside what is allowed: a controller with a wrong model overshoots.
inline constexpr double kCommissionMargin_mm = 0.15;
inline constexpr double kCommissionShareOfTop = 0.95;
/// The least that the masses may be of what a catalogue states.
inline constexpr double kLightestOfCatalogue = 0.7;

/// Strokes forth and back at each of the speeds.
std::string CreepProgram(const std::string& axis, double stroke_mm, const std::vector<double>& speeds_mm_s,
                         double dwell_s);

/// Force of the chirp at the table: a share of the rated one, which a catalogue states exactly.
double CommissionChirp_N(const AxisConfig& axis);
/// Of the chirp that shakes the sliding axis: more where a drive closes the loop.
double CommissionShaking_N(const AxisConfig& axis);
/// Less room than this on one side is none.
inline constexpr double kLeastCommissionStroke_mm = 1.0;

/// The motions of a plan whose limits and ends are known, from the slowest on, for an axis that stands at
/// `position_mm`.
std::vector<CommissionMotion> CommissionMotions(const CommissionPlan& plan, const AxisConfig& axis,
                                                double position_mm, double cycle_us);

}  // namespace contour
