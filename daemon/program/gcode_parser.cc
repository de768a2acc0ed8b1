#include "daemon/program/gcode_parser.h"

#include "daemon/program/gcode/canonical_text.h"
#include "daemon/program/gcode/move_list.h"
#include "daemon/program/gcode/program_run.h"

namespace contour {

GcodeMoves ParseGcode(std::string_view text, const std::string& name, const GcodeSettings& settings) {
  MoveList list(name, settings);
  ProgramRun(text, name, settings, [&](const CanonicalMove& move) { list.Add(move); }).Run();
  return list.Finish();
}

std::string CanonicalText(std::string_view text, const std::string& name, const GcodeSettings& settings) {
  std::string lines;
  ProgramRun(text, name, settings, [&](const CanonicalMove& move) { AppendCanonical(move, lines); }).Run();
  return lines;
}

}  // namespace contour
