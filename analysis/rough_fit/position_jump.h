#pragma once

#include <string>

#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// Where the position goes further from one row to the next than anywhere else by far: an encoder that lost
/// its reference, or stood still and came back. Nothing that is computed from such a log means anything.
/// Empty where it does not; single wrong readings are taken out before (TakeOutWrongReadings).
std::string PositionJump(const AxisLog& log);

}  // namespace contour::diagnosis
