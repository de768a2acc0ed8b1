#pragma once

#include "analysis/axis_model/axis_model.h"

namespace contour::diagnosis {

/// The same axis in another coordinate x, where q = x * lever. Signals stay as they are.
AxisModel SeenWithLever(AxisModel model, double lever);

}  // namespace contour::diagnosis
