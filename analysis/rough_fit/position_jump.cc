#include "analysis/rough_fit/position_jump.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// [rows] A motion is as fast in the rows next to one, whatever its acceleration.
constexpr std::size_t kNext = 3;
/// [of the fastest elsewhere] A reading that was not renewed for a few rows catches up with less.
constexpr double kFarFaster = 10.0;

/// Travel to the next row; 0 where either is missing.
std::vector<double> StepsOf(const AxisLog& log) {
  std::vector<double> steps(log.size() - 1, 0.0);
  for (std::size_t k = 0; k + 1 < log.size(); ++k)
    if (log.present[k] != 0 && log.present[k + 1] != 0)
      steps[k] = std::fabs(log.position[k + 1] - log.position[k]);
  return steps;
}

}  // namespace

std::string PositionJump(const AxisLog& log) {
  if (log.size() < 2) return {};
  const std::vector<double> steps = StepsOf(log);
  const auto at = static_cast<std::size_t>(std::max_element(steps.begin(), steps.end()) - steps.begin());
  double elsewhere = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (k + kNext < at || k > at + kNext) elsewhere = std::max(elsewhere, steps[k]);
  if (!(steps[at] > kFarFaster * elsewhere) || !(elsewhere > 0.0)) return {};
  return "the position jumps by " + RoundedText(log.linear ? 1e3 * steps[at] : steps[at]) +
         (log.linear ? " mm" : " rad") + " from one row to the next at " +
         RoundedText(log.period_s * static_cast<double>(at + 1)) + " s, and by no more than " +
         RoundedText(log.linear ? 1e3 * elsewhere : elsewhere) +
         " anywhere else: the encoder lost its reference there, or stood still. Use what lies before it or "
         "after it";
}

}  // namespace contour::diagnosis
