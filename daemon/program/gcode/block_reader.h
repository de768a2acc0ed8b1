#pragma once

#include "daemon/program/gcode/block.h"
#include "daemon/program/gcode/line_text.h"

namespace contour {

/// Reads the words of a line from where `text` stands; a block number has been taken off.
/// Throws ProgramError for words and codes that are not known, twice there, or two of one modal group.
void ReadBlock(LineText& text, const Parameters& parameters, const std::string& name, Block& block);

/// Takes a leading slash off; true when there was one.
bool TakeBlockDelete(LineText& text);
/// Takes a leading block number off.
void TakeBlockNumber(LineText& text);

}  // namespace contour
