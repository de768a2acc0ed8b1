#pragma once

#include <string_view>

#include "analysis/axis_model/stated_axis.h"

namespace contour::diagnosis {

/// Mass, screw and friction by the names that a fit has for them (inertia, Fc, s0 ...): this one times
/// `factor`, in both directions where it has two. False: the axis has none of this name.
bool ScaleParameter(StatedAxis& axis, std::string_view name, double factor);

}  // namespace contour::diagnosis
