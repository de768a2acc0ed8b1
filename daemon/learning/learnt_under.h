#pragma once

#include <string>
#include <string_view>

#include "daemon/program/placed_program.h"

namespace contour {

/// What tells programs apart that are learnt: their text, how far the machine stands from their zero, and the
/// lengths of tools where they ask for them (`tool_table`: the file; empty: none). A program that has to go
/// to its zero first is another one than the same program that stands there, and one whose tool was measured
/// anew follows another path. Throws ProgramError where the table cannot be read.
[[nodiscard]] std::string LearntUnder(std::string_view text, const Placement& place,
                                      const std::string& tool_table);

}  // namespace contour
