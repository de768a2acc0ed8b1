#pragma once

#include <string>

#include "daemon/program/shapes.h"

namespace contour {

/// One sentence that names the words of a program, after UseEvents, that do nothing: no output listens to
/// them, or they do not wait. Empty when there are none. `name`
/// stands for its file; `simulated`: nobody is there to let it go on, so nothing waits.
std::string IgnoredEvents(const GcodeMoves& program, const std::string& name, bool simulated = false);

}  // namespace contour
