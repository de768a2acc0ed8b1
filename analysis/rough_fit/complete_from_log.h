#pragma once

#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// What the model file leaves open comes from the log, with the uncertainty of a first look; a current
/// becomes a torque, by the stated constant or by the one that makes the stated inertia that of the log.
/// Gives what was assumed, in plain words. Throws ConfigError where the log does not say it.
std::vector<std::string> CompleteFromLog(AxisLog& log, StatedAxis& stated);

/// Which constant an axis's forces stand on, in place of what the notes said of it.
void SayAmpere(const StatedAxis& axis, bool linear, std::vector<std::string>& notes);

}  // namespace contour::diagnosis
