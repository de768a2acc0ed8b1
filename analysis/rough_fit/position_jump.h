#pragma once

#include <span>
#include <string>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// Where the position goes further from one row to the next than anywhere else by far: an encoder that lost
/// its reference, or stood still and came back. Nothing that is computed from such a log means anything.
/// Empty where it does not; single wrong readings are taken out before (TakeOutWrongReadings).
std::string PositionJump(const AxisLog& log);
/// The same of files that are looked at in a row, with the name of the one: a time in all of them is in none.
/// What is to be taken out before is taken out of copies.
std::string PositionJump(std::span<const AxisLog> logs, const StatedAxis& stated);

}  // namespace contour::diagnosis
