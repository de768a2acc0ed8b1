#pragma once

#include <optional>
#include <string>

#include "daemon/program/shapes.h"

namespace contour {

/// How a G-code program is to be run, other than from its beginning to its end.
struct PartOfProgram {
  int from_line = 0;          ///< 0: from the beginning
  bool go_there = false;      ///< at rapid to where that line begins, if the machine stands elsewhere
  bool single_block = false;  ///< at rest at the end of every line
  std::optional<bool> optional_stop{};  ///< M1 waits for the operator; nothing: as the machine file says
  std::optional<bool> block_delete{};   ///< lines that begin with a slash are left out; likewise
  std::string tool_table{};             ///< file that G43 takes tools' lengths from; empty: none
};

/// The moves from that line on. Moves before it are read, so that its words mean what they mean there, and
/// not made; events before it, such as a spindle's start, are left out. Throws ProgramError: there is no move
/// from that line on, it is within a sub, which may run more than once, or the machine stands elsewhere and
/// is not to go there.
GcodeMoves FromLine(GcodeMoves moves, const std::string& name, const PartOfProgram& part);

/// All corners become stops, so that every line can end at rest.
GcodeMoves WithStops(GcodeMoves moves);

}  // namespace contour
