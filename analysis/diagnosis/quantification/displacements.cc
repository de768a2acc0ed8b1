#include "analysis/diagnosis/quantification/displacements.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "analysis/prediction_error/outlier_rows.h"
#include "analysis/prediction_error/stands_out.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// What the steps to rows `from` to `to` bring beyond the mean of the steps before and after them, which is
/// nothing under a constant acceleration. NaN where a row is missing.
double Beyond(const std::vector<double>& position, std::size_t from, std::size_t to) {
  const double before = position[from - 1] - position[from - 2];
  const double after = position[to + 1] - position[to];
  return position[to] - position[from - 1] - static_cast<double>(to - from + 1) * 0.5 * (before + after);
}

/// How far the axis is off from row k on; nothing where one reading is wrong or late.
double Displacement(const std::vector<double>& position, std::size_t k) { return Beyond(position, k, k + 1); }

/// Whether it was where it had been going for some rows before row k, and is away for some rows after it.
bool Stays(const std::vector<double>& position, std::size_t k, double by) {
  const double far = Beyond(position, k - kOutlierRows, k + kOutlierRows);
  return 2.0 * far * by > by * by;
}

/// Whether the reading was held in rows that this looks at: what it makes up for afterwards is no jump.
bool Held(const Problem& problem, std::size_t k) {
  const std::vector<double>& position = problem.log.position;
  for (std::size_t i = k - kOutlierRows - 1; i <= k + kOutlierRows + 1; ++i)
    if (problem.setup.valid[i] == 0 && position[i] == position[i - 1]) return true;
  return false;
}

/// How large that may be where nothing is wrong: the largest force of the log drives what the encoder sits on
/// one direction in one row and the other in the next.
double WithinReach(const AxisLog& log, const AxisModel& model) {
  double largest = 0.0;
  for (const double u : log.command) largest = std::max(largest, std::fabs(model.torque_gain * u));
  const StatedFriction& f = model.friction;
  largest += std::fabs(model.offset) + std::max({f.Fc_plus, f.Fc_minus, f.Fs_plus, f.Fs_minus});
  return 2.0 * largest / model.motor_inertia * log.period_s * log.period_s;
}

std::vector<double> Displacements(const std::vector<double>& position) {
  std::vector<double> out(position.size(), 0.0);
  for (std::size_t k = 2; k + 2 < position.size(); ++k) out[k] = Displacement(position, k);
  return out;
}

}  // namespace

void TellDisplacements(const Problem& problem, const Point& fitted, Diagnosis& out) {
  const AxisLog& log = problem.log;
  const double within_reach = WithinReach(log, problem.Build(fitted));
  const std::vector<double> displaced = Displacements(log.position);
  // Noise and steps of the encoder move rows, too.
  StandsOut stands_out(displaced, problem.stated.position_step);
  std::string first, largest_at;
  std::size_t count = 0, told_to = 0;
  double largest = 0.0;
  const auto size_text = [&](double by) {
    return log.linear ? RoundedText(1e3 * by) + " mm" : RoundedText(by) + " rad";
  };
  for (std::size_t k = kOutlierRows + 2; k + kOutlierRows + 1 < log.size(); ++k) {
    if (problem.setup.valid[k] != 0 || log.present[k] == 0) continue;
    const double by = displaced[k];
    if (!(std::fabs(by) > within_reach) || Held(problem, k)) continue;
    if (!stands_out(k) || !Stays(log.position, k, by)) continue;
    const std::string at = RoundedText(log.period_s * static_cast<double>(k)) + " s";
    // The row before a jump is seen to be off, too.
    if (k >= told_to && count++ == 0) first = at;
    told_to = k + kOutlierRows;
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
