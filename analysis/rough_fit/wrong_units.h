#pragma once

#include <string>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// A log in other units than it says, or with one sign turned round, is no axis's: friction of nothing and
/// noise explain it as well as any cause. What to look at, where least squares see the motion in the force
/// and the inertia is one that the model cannot mean; else nothing.
std::string WrongUnits(const AxisLog& log, const StatedAxis& stated);

}  // namespace contour::diagnosis
