#include "daemon/program/gcode/ignored_events.h"

#include <set>

namespace contour {

std::string IgnoredEvents(const GcodeMoves& program, const std::string& name) {
  std::set<std::string> words;
  int first = 0;
  bool holds = false;
  for (const GcodeEvent& event : program.events) {
    if (first == 0) first = event.line;
    holds = holds || event.holds();
    if (!event.holds())
      words.insert(event.letter == 'M' ? "M" + std::to_string(event.code) : std::string(1, event.letter));
  }
  if (first == 0) return "";
  std::string text = name + ":" + std::to_string(first) + ": ";
  for (const std::string& word : words)
    text += (word == *words.begin() ? "no output listens to " : ", ") + word;
  if (!words.empty()) text += ": ignored, here and below";
  if (!words.empty() && holds) text += "; ";
  if (holds) text += "M0 and M1 stop for an instant and do not hold";
  return text;
}

}  // namespace contour
