#pragma once

#include <filesystem>

#include "daemon/program/gcode/program_halts.h"

namespace contour {

/// Says once, on stderr, which words of a G-code program do nothing here. A program that cannot be read is
/// not this function's business.
void WarnOfIgnoredWords(const std::filesystem::path& program, const EventUse& use, bool simulated);

}  // namespace contour
