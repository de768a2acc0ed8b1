#pragma once

#include "analysis/axis_model/stated_axis.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// Of an axis whose friction nobody stated: whether it falls with the speed (Stribeck), and by which
/// exponent, as makes the log likeliest with all other numbers fitted and the noise learnt with them. Where
/// it falls, break-away level, speed and damping of the bristle join the numbers that the log is to say, and
/// are no cause; else, and where the log is too short for that, the level stays one.
void OpenFallingFriction(const AxisLog& log, StatedAxis& stated);

}  // namespace contour::diagnosis
