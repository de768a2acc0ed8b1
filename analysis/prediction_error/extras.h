#pragma once

#include "analysis/axis_model/axis_model.h"
#include "analysis/axis_model/stated_axis.h"
#include "analysis/prediction_error/signals.h"

namespace contour::diagnosis {

/// What the stated model has beyond its numbers, as signals along the log: part of the base from then on, so
/// that it is not found again and other causes are looked for in addition to it. Takes the kinematic part of
/// Signals.
void AddExtras(const StatedExtras& extras, const Signals& signals, AxisModel& model);

}  // namespace contour::diagnosis
