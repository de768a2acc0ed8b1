#pragma once

#include <string>

#include "daemon/program/shapes.h"

namespace contour {

/// One sentence that names the words which ask for outputs, as no output is switched by them; empty when the
/// program has none. `name` stands for its file.
std::string IgnoredEvents(const GcodeMoves& program, const std::string& name);

}  // namespace contour
