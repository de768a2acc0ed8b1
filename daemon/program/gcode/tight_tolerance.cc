#include "daemon/program/gcode/tight_tolerance.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace contour {

std::string TightTolerance(const GcodeMoves& program, const std::string& name, double following_m) {
  int first = 0;
  double least_m = 0.0;
  for (const GcodeMove& move : program.moves) {
    if (move.corner != GcodeMove::Corner::kBlended || !(move.tolerance_m > 0.0)) continue;
    // Half of it is the most that planned paths leave to the machine (BlendDeviation_m).
    if (0.5 * move.tolerance_m >= following_m) continue;
    if (first == 0) first = move.line;
    least_m = least_m > 0.0 ? std::min(least_m, move.tolerance_m) : move.tolerance_m;
  }
  if (first == 0) return "";
  std::array<char, 256> text{};
  std::snprintf(
      text.data(), text.size(),
      ":%d: a tolerance of %.3g mm leaves the machine %.3g mm; it is expected to be off its path by "
      "%.3g mm, at any speed (machine.path_following_mm)",
      first, 1e3 * least_m, 0.5e3 * least_m, 1e3 * following_m);
  return name + text.data();
}

}  // namespace contour
