#include "daemon/output_words.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "config/number_text.h"

namespace contour {
namespace {

constexpr double kLargestTool = std::numeric_limits<std::uint16_t>::max();

}  // namespace

bool Listens(const ProgramOutputsConfig& outputs, const GcodeEvent& event) {
  if (event.letter == 'S') return outputs.spindle_speed.has_value();
  if (event.letter == 'T') return outputs.tool_number.has_value();
  switch (event.code) {
    case 3:
      return outputs.spindle_forward.has_value();
    case 4:
      return outputs.spindle_backward.has_value();
    case 5:
      return outputs.spindle_forward || outputs.spindle_backward;
    case 6:
      return outputs.tool_change.has_value();
    case 7:
      return outputs.mist.has_value();
    case 8:
      return outputs.flood.has_value();
    case 9:
      return outputs.mist || outputs.flood;
    default:
      return false;
  }
}

std::string Problem(const ProgramOutputsConfig& outputs, const GcodeEvent& event) {
  if (event.letter == 'S' && !(std::abs(event.value) <= outputs.spindle_speed->largest_rpm))
    return "S" + RoundedText(event.value) +
           " is beyond io.modbus.outputs.program.spindle_speed.largest_rpm, " +
           RoundedText(outputs.spindle_speed->largest_rpm);
  if (event.letter == 'T' &&
      !(event.value >= 0.0 && event.value <= kLargestTool && event.value == std::floor(event.value)))
    return "T" + RoundedText(event.value) + ": expected a whole number from 0 to " +
           RoundedText(kLargestTool) + ", what the register of tool_number holds";
  return {};
}

std::vector<std::string> WordsOf(const MachineConfig& machine) {
  std::vector<std::string> words;
  if (!machine.io.modbus || !machine.io.modbus->outputs.program) return words;
  const ProgramOutputsConfig& outputs = *machine.io.modbus->outputs.program;
  for (const int code : {3, 4, 5, 6, 7, 8, 9}) {
    GcodeEvent event;
    event.code = code;
    if (Listens(outputs, event)) words.push_back(NameOf(event));
  }
  if (outputs.spindle_speed) words.emplace_back("S");
  if (outputs.tool_number) words.emplace_back("T");
  return words;
}

EventUse UseOfEvents(const MachineConfig& machine, bool optional_stop) {
  EventUse use;
  use.optional_stop = optional_stop;
  if (!machine.io.modbus || !machine.io.modbus->outputs.program) return use;
  const ProgramOutputsConfig outputs = *machine.io.modbus->outputs.program;
  use.switches = [outputs](const GcodeEvent& event) { return Listens(outputs, event); };
  use.problem = [outputs](const GcodeEvent& event) { return Problem(outputs, event); };
  use.tool_change_holds = !outputs.tool_change || outputs.tool_change->hold;
  return use;
}

}  // namespace contour
