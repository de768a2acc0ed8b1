#include "tools/contour/ignored_words.h"

#include <iostream>

#include "daemon/program/gcode/ignored_events.h"
#include "daemon/program/gcode_parser.h"
#include "daemon/program/program.h"

namespace contour {

void WarnOfIgnoredWords(const std::filesystem::path& program, const EventUse& use, bool simulated) {
  if (FormatOf(program) != ProgramFormat::kGcode) return;
  try {
    GcodeMoves moves = ParseGcode(ReadProgramText(program), program.string());
    UseEvents(moves, program.string(), use);
    const std::string warning = IgnoredEvents(moves, program.string(), simulated);
    if (!warning.empty()) std::cerr << "warning: " << warning << "\n";
  } catch (const ProgramError&) {
    // Whoever runs the program says what is wrong with it.
  }
}

}  // namespace contour
