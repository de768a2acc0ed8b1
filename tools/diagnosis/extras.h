#pragma once

#include "tools/diagnosis/axis_model.h"
#include "tools/diagnosis/signals.h"
#include "tools/diagnosis/stated_axis.h"

namespace contour::diagnosis {

/// What the stated model has beyond its numbers, as signals along the log: part of the base from then on, so
/// that it is not found again and other causes are looked for beside it. Takes the kinematic part of Signals.
void AddExtras(const StatedExtras& extras, const Signals& signals, AxisModel& model);

}  // namespace contour::diagnosis
