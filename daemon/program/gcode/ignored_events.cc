#include "daemon/program/gcode/ignored_events.h"

#include <set>

namespace contour {

std::string IgnoredEvents(const GcodeMoves& program, const std::string& name) {
  std::set<std::string> words;
  int first = 0;
  for (const GcodeEvent& event : program.events) {
    if (event.holds()) continue;
    words.insert(event.letter == 'M' ? "M" + std::to_string(event.code) : std::string(1, event.letter));
    if (first == 0) first = event.line;
  }
  if (words.empty()) return "";
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return name + ":" + std::to_string(first) + ": no output listens to " + list + ": ignored, here and below";
}

}  // namespace contour
