#pragma once

#include <string>

#include "daemon/program/shapes.h"

namespace contour {

/// One sentence that names the words which do less than they ask for: no output is switched, and nothing
/// holds at M0 and M1. Empty when the program has none. `name` stands for its file.
std::string IgnoredEvents(const GcodeMoves& program, const std::string& name);

}  // namespace contour
