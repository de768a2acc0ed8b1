#pragma once

#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// Takes single wrong readings of the position out of a log, as if their rows were missing: a lost or garbled
/// frame, after which the axis is where it would have been. Derivatives, speeds and strokes are taken from
/// the position before any model has run. A jump of the speed, as at a stop, is none.
void TakeOutWrongReadings(AxisLog& log, double position_step);

}  // namespace contour::diagnosis
