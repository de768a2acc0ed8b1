#include "analysis/rough_fit/position_jump.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "analysis/prediction_error/wrong_readings.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// [of the steps next to it, and of the largest elsewhere] A motion is as fast in the rows next to one,
/// whatever its acceleration; a reading that was not renewed for a few rows catches up with less.
constexpr double kFarLarger = 10.0;

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
  const auto alone = [&](std::size_t k) {
    const double before = k > 0 ? steps[k - 1] : 0.0, after = k + 1 < steps.size() ? steps[k + 1] : 0.0;
    return steps[k] > kFarLarger * std::max(before, after);
  };
  double elsewhere = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (!alone(k)) elsewhere = std::max(elsewhere, steps[k]);
  std::size_t at = 0;
  while (at < steps.size() && !(alone(at) && steps[at] > kFarLarger * elsewhere)) ++at;
  if (at == steps.size() || !(elsewhere > 0.0)) return {};
  const auto told = [&](double step) {
    return log.linear ? RoundedText(1e3 * step) + " mm" : RoundedText(step) + " rad";
  };
  return "the position jumps by " + told(steps[at]) + " from one row to the next, " +
         RoundedText(log.period_s * static_cast<double>(at + 1)) +
         " s after the first row, and by no more than " + told(elsewhere) +
         " anywhere else: the encoder lost its reference there, or stood still. Use what lies before it or "
         "after it";
}

std::string PositionJump(std::span<const AxisLog> logs, const StatedAxis& stated) {
  for (const AxisLog& log : logs) {
    AxisLog sound = log;
    TakeOutWrongReadings(sound, stated.position_step);
    if (const std::string why = PositionJump(sound); !why.empty()) return log.source + ": " + why;
  }
  return {};
}

}  // namespace contour::diagnosis
