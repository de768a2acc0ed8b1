#pragma once

#include <string>

#include "daemon/program/shapes.h"

namespace contour {

/// A machine is expected to be `following_m` off the path that it is to follow. A sentence, with the line of
/// the first, on moves whose tolerance is less than twice that; empty where there are none.
std::string TightTolerance(const GcodeMoves& program, const std::string& name, double following_m);

}  // namespace contour
