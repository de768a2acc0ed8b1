#pragma once

#include <filesystem>

#include "daemon/program/gcode/program_halts.h"

namespace contour {

/// What of a G-code program is not carried out to the letter here, once, on stderr: words that do nothing,
/// and a tolerance that the machine, `following_m` from its path, is not expected to keep. A program that
/// cannot be read is not this function's business.
void WarnOfProgram(const std::filesystem::path& program, const EventUse& use, bool simulated,
                   double following_m);

}  // namespace contour
