#include "daemon/program/gcode/ignored_events.h"

#include <set>

#include "daemon/program/gcode/program_halts.h"

namespace contour {

std::string IgnoredEvents(const GcodeMoves& program, const std::string& name, bool simulated) {
  std::set<std::string> deaf;
  std::set<std::string> passed;
  int first = 0;
  for (const GcodeEvent& event : program.events) {
    const bool waits_here = event.waits && !simulated;
    if (waits_here || (event.acts && !event.waits)) continue;
    (event.waits || event.holds() ? passed : deaf).insert(NameOf(event));
    if (first == 0) first = event.line;
  }
  if (first == 0) return "";
  const auto list = [](const std::set<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
  };
  std::string text = name + ":" + std::to_string(first) + ": ";
  if (!deaf.empty()) text += "no output listens to " + list(deaf) + ": ignored, here and below";
  if (!deaf.empty() && !passed.empty()) text += "; ";
  if (!passed.empty())
    text += simulated ? "a simulation goes on at " + list(passed)
                      : list(passed) + " does not wait without --optional-stop";
  return text;
}

}  // namespace contour
