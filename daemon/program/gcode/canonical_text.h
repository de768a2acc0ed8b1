#pragma once

#include <string>

#include "daemon/program/gcode/canonical_move.h"

namespace contour {

/// One line for people and for comparison with LinuxCNC's `rs274`: source line, what is done, where to.
void AppendCanonical(const CanonicalMove& move, std::string& lines);

}  // namespace contour
