#include "tools/contour/path_section.h"

#include <algorithm>

#include "config/loop_axis.h"
#include "config/number_text.h"
#include "design/path_following.h"

namespace contour {

std::string PathSection(const MachineConfig& machine) {
  const bool stated = machine.machine.path_following_mm.has_value();
  const double following_mm = stated ? *machine.machine.path_following_mm : ExpectedFollowing_mm(machine);
  const double tolerance_mm = PathTolerance_mm(machine, following_mm);
  const double left_mm = std::min(following_mm, 0.5 * tolerance_mm);
  std::string text = "\nPaths of G-code\n  tolerance " + RoundedText(tolerance_mm) +
                     " mm where a program states none: " + RoundedText(tolerance_mm - left_mm) +
                     " mm for the smooth path, " + RoundedText(left_mm) +
                     " mm for the machine to follow it\n  " +
                     (stated ? "machine.path_following_mm: " : "expected of loops and screws: ") +
                     RoundedText(following_mm) + " mm\n";
  if (following_mm > left_mm)
    text += "  it follows by more than half of that tolerance: programs may be off by " +
            RoundedText(tolerance_mm - left_mm + following_mm) +
            " mm; stiffer loops, or what `contour run` measures as machine.path_following_mm\n";
  return text;
}

}  // namespace contour
