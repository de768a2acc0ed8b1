#include "daemon/learning/learnt_under.h"

#include <cmath>
#include <cstddef>

#include "daemon/program/gcode/tool_table.h"
#include "daemon/program/program.h"

namespace contour {

std::string LearntUnder(std::string_view text, const Placement& place, const std::string& tool_table) {
  std::string key(text);
  if (!tool_table.empty() && AsksForLengths(text)) key += '\n' + ReadProgramText(tool_table);
  // In whole hundredths of a millimetre: two passes do not end at the same bit.
  for (std::size_t i = 0; i < place.zero_m.size(); ++i)
    key += '\n' + std::to_string(std::lround(1e5 * (place.start_m[i] - place.zero_m[i])));
  return key;
}

}  // namespace contour
