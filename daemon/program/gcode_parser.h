#pragma once

#include <string>
#include <string_view>

#include "daemon/program/shapes.h"

namespace contour {

/// Reads RS-274 G-code as far as docs/programs.md lists it. `name` stands for the file in messages.
/// Throws ProgramError, with the line, for anything else.
GcodeMoves ParseGcode(std::string_view text, const std::string& name);

}  // namespace contour
