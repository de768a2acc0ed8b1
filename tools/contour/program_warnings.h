#pragma once

#include <filesystem>

#include "daemon/program/gcode/program_halts.h"

namespace contour {

/// What of a G-code program is not carried out to the letter here, once, on stderr: words that do nothing,
/// and a tolerance that the machine, `following_m` from its path, is not expected to keep. A program that
/// cannot be read is not this function's business. `block_delete`: lines that begin with a slash are left
/// out.
void WarnOfProgram(const std::filesystem::path& program, const EventUse& use, bool block_delete,
                   bool simulated, double following_m);

}  // namespace contour
