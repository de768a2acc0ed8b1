#pragma once

#include <filesystem>

#include "daemon/program/gcode/program_halts.h"
#include "daemon/program/part_of_program.h"

namespace contour {

/// What of a G-code program is not carried out to the letter here, once, on stderr: words that do nothing,
/// and a tolerance that the machine, `following_m` from its path, is not expected to keep. A program that
/// cannot be read is not this function's business. `part` says how it is read.
void WarnOfProgram(const std::filesystem::path& program, const EventUse& use, const PartOfProgram& part,
                   bool simulated, double following_m);

}  // namespace contour
