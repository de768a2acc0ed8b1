#pragma once

#include <string>

#include "daemon/program/shapes.h"

namespace contour {

/// One sentence where moves ask for a smaller tolerance than leaves a machine that may be `following_m` from
/// the path that it is to follow half of it; the first such line. Empty: there are none.
std::string TightTolerance(const GcodeMoves& program, const std::string& name, double following_m);

}  // namespace contour
