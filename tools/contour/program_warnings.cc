#include "tools/contour/program_warnings.h"

#include <iostream>
#include <string>

#include "daemon/program/gcode/ignored_events.h"
#include "daemon/program/gcode/tight_tolerance.h"
#include "daemon/program/gcode_parser.h"
#include "daemon/program/program.h"

namespace contour {

void WarnOfProgram(const std::filesystem::path& program, const EventUse& use, const PartOfProgram& part,
                   bool simulated, double following_m) {
  if (FormatOf(program) != ProgramFormat::kGcode) return;
  try {
    // Words and tolerances are the same wherever program zero is, so that G28, G30 and G53 may be read.
    GcodeSettings settings;
    settings.block_delete = part.block_delete.value_or(settings.block_delete);
    settings.tool_table = part.tool_table;
    settings.zero_m.emplace().fill(0.0);
    GcodeMoves moves = ParseGcode(ReadProgramText(program), program.string(), settings);
    UseEvents(moves, program.string(), use);
    for (const std::string& warning : {IgnoredEvents(moves, program.string(), simulated),
                                       TightTolerance(moves, program.string(), following_m)})
      if (!warning.empty()) std::cerr << "warning: " << warning << "\n";
  } catch (const ProgramError&) {
    // Whoever runs the program says what is wrong with it.
  }
}

}  // namespace contour
