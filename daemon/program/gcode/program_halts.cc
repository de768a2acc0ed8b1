#include "daemon/program/gcode/program_halts.h"

#include <array>
#include <cstdio>

#include "daemon/program/program.h"

namespace contour {

void UseEvents(GcodeMoves& program, const std::string& name, const EventUse& use) {
  double tool = -1.0;
  for (GcodeEvent& event : program.events) {
    if (event.letter == 'T') tool = event.value;
    const bool switches = use.switches && use.switches(event);
    const std::string problem = switches && use.problem ? use.problem(event) : std::string();
    if (!problem.empty()) throw ProgramError(name + ":" + std::to_string(event.line) + ": " + problem);
    if (event.letter == 'M') {
      event.waits = event.code == 0 || (event.code == 1 && use.optional_stop) ||
                    (event.code == 6 && use.tool_change_holds);
      if (event.code == 6) event.value = tool;
    }
    event.acts = event.waits || switches;
    if (event.acts && event.before_move > 0) program.moves.StopAfter(event.before_move - 1);
  }
}

std::vector<ProgramHalt> HaltsOf(const GcodeMoves& program) {
  std::vector<ProgramHalt> halts;
  for (const GcodeEvent& event : program.events) {
    if (!event.acts) continue;
    if (halts.empty() || halts.back().before_move != event.before_move)
      halts.push_back({event.before_move, {}});
    halts.back().events.push_back(event);
  }
  return halts;
}

std::string NameOf(const GcodeEvent& event) {
  return event.letter == 'M' ? "M" + std::to_string(event.code) : std::string(1, event.letter);
}

std::string WordOf(const GcodeEvent& event) {
  std::array<char, 48> text{};
  if (event.letter != 'M') {
    std::snprintf(text.data(), text.size(), "%c%g", event.letter, event.value);
  } else if (event.code == 6 && event.value >= 0.0) {
    std::snprintf(text.data(), text.size(), "T%g M6", event.value);
  } else {
    std::snprintf(text.data(), text.size(), "M%d", event.code);
  }
  return text.data();
}

}  // namespace contour
