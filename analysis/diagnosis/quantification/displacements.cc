#include "analysis/diagnosis/quantification/displacements.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// How far the axis is off from row k on: what two steps have brought beyond their neighbours, which is
/// nothing under a constant acceleration, and nothing where a reading is wrong or late. NaN where a row is
/// missing.
double Displacement(const std::vector<double>& position, std::size_t k) {
  const auto step = [&](std::size_t to) { return position[to] - position[to - 1]; };
  return step(k) + step(k + 1) - step(k - 1) - step(k + 2);
}

/// How large that may be where nothing is wrong: the largest command of the log drives what the encoder sits
/// on one direction in one row and the other in the next.
double WithinReach(const AxisLog& log, const AxisModel& model) {
  double largest = 0.0;
  for (const double u : log.command) largest = std::max(largest, std::fabs(model.torque_gain * u));
  return 2.0 * largest / model.motor_inertia * log.period_s * log.period_s;
}

}  // namespace

void TellDisplacements(const Problem& problem, const Point& fitted, Diagnosis& out) {
  const AxisLog& log = problem.log;
  const double within_reach = WithinReach(log, problem.Build(fitted));
  std::string first, largest_at;
  std::size_t count = 0;
  double largest = 0.0;
  const auto size_text = [&](double by) {
    return log.linear ? RoundedText(1e3 * by) + " mm" : RoundedText(by) + " rad";
  };
  for (std::size_t k = 2; k + 2 < log.size(); ++k) {
    if (problem.setup.valid[k] != 0 || log.present[k] == 0 || log.position[k] == log.position[k - 1])
      continue;
    const double by = Displacement(log.position, k);
    if (!(std::fabs(by) > within_reach)) continue;
    const std::string at = RoundedText(log.period_s * static_cast<double>(k)) + " s";
    if (count++ == 0) first = at;
    if (std::fabs(by) <= std::fabs(largest)) continue;
    largest = by;
    largest_at = at;
  }
  if (count == 0) return;
  const std::string times = count == 1 ? "once, at " + first + ", by "
                                       : std::to_string(count) + " times, at " + first +
                                             " first, by up to (at " + largest_at + ") ";
  out.notes.push_back(
      "The position jumps within one row and stays there, further than any torque of the log moves the axis "
      "in a row: " +
      times + size_text(largest) +
      ". An encoder that loses counts, a coupling that slips, or a reference that was set anew; the rows are "
      "left out, and what goes with the position is known with less certainty.");
}

}  // namespace contour::diagnosis
