#pragma once

#include <string>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// Why a log says nothing of its axis: the axis stands still, its force never changes, or least squares see
/// neither an inertia nor friction in the force, as with the force of another axis. Any cause would "explain"
/// such a log. Empty where the motion is in the force.
std::string UnrelatedForce(const AxisLog& log, const StatedAxis& stated);

}  // namespace contour::diagnosis
