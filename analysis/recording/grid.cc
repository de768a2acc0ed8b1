#include "analysis/recording/grid.h"

#include <algorithm>
#include <cmath>

#include "analysis/recording/axis_log.h"
#include "config/config_error.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// [periods] Root mean square off the grid. Beyond it times are not the grid's to within rounding, and a
/// speed taken from them is off by as much of it.
constexpr double kMostScatter = 0.05;

/// A table that states 1 ms to six digits means 1 ms.
double Rounded(double period_s) {
  const double whole_us = std::round(period_s * 1e6) * 1e-6;
  return whole_us > 0.0 && std::abs(period_s - whole_us) < 1e-6 * whole_us ? whole_us : period_s;
}

std::vector<double> StepsOf(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  return steps;
}

double Quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// What somebody needs to know whose rows come as they come.
std::string Advice(const std::vector<double>& time_s, double period_s) {
  const std::vector<double> steps = StepsOf(time_s);
  const double rate_Hz = std::round(1.0 / period_s * 10.0) / 10.0;
  return ": rows must be a fixed time apart, though some may be missing. Nine of ten come " +
         RoundedText(1e3 * Quantile(steps, 0.05)) + " to " + RoundedText(1e3 * Quantile(steps, 0.95)) +
         " ms after the one before, on the mean " + RoundedText(1e3 * period_s) + " ms; --resample " +
         NumberText(rate_Hz) + " puts them on a grid";
}

/// Of times that stand still, as those do that are written in too few digits.
std::string WhyStill(const std::vector<double>& time_s) {
  const std::vector<double> steps = StepsOf(time_s);
  const auto still = std::count(steps.begin(), steps.end(), 0.0);
  const double all_s = time_s.back() - time_s.front();
  std::string text = " (" + std::to_string(still) + " of " + std::to_string(steps.size()) +
                     " times are those of the row before: written in too few digits, or of a clock coarser "
                     "than the rows). Where rows come at a fixed rate, take the column out and state it by "
                     "--sample-rate HZ";
  if (all_s > 0.0) text += ", on the mean " + RoundedText(static_cast<double>(steps.size()) / all_s) + " Hz";
  return text;
}

}  // namespace

void DemandRisingTime(const std::string& file, const std::vector<double>& time_s,
                      const std::vector<std::size_t>& line) {
  if (time_s.size() < 3) throw ConfigError({file + ": has fewer than three rows"});
  for (std::size_t i = 1; i < time_s.size(); ++i)
    if (!(time_s[i] > time_s[i - 1]))
      throw ConfigError({file + ":" + std::to_string(line[i]) + ": time_s: found " + NumberText(time_s[i]) +
                         " after " + NumberText(time_s[i - 1]) + ", expected time to go on" +
                         (time_s[i] == time_s[i - 1] ? WhyStill(time_s) : std::string())});
}

Grid FindGrid(const std::string& file, const std::vector<double>& time_s,
              const std::vector<std::size_t>& line) {
  DemandRisingTime(file, time_s, line);
  const double median = Quantile(StepsOf(time_s), 0.5);
  Grid grid;
  grid.index.assign(time_s.size(), 0);
  std::vector<std::size_t> begins = {0};
  double seconds = 0.0, periods = 0.0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double step = time_s[i] - time_s[i - 1];
    const double steps_on = std::round(step / median);
    if (steps_on < 1.0)
      throw ConfigError(
          {file + ":" + std::to_string(line[i]) + ": time_s: found " + NumberText(time_s[i]) + ", " +
           RoundedText(1e6 * step) + " us after the row before, expected " + RoundedText(1e6 * median) +
           Advice(time_s, (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1))});
    const auto on = static_cast<std::size_t>(steps_on);
    grid.index[i] = grid.index[i - 1] + on;
    if (IsGap(on - 1, median)) {
      begins.push_back(i);
      continue;
    }
    seconds += step;
    periods += steps_on;
  }
  grid.period_s = Rounded(periods > 0.0 ? seconds / periods : median);
  double squares = 0.0;
  for (std::size_t b = 0; b < begins.size(); ++b) {
    const std::size_t from = begins[b], to = b + 1 < begins.size() ? begins[b + 1] : time_s.size();
    double sum = 0.0, sum_of_squares = 0.0;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double off =
          time_s[i] - time_s[from] - grid.period_s * static_cast<double>(grid.index[i] - grid.index[from]);
      sum += off;
      sum_of_squares += off * off;
      if (std::abs(off) > 0.25 * grid.period_s)
        throw ConfigError({file + ":" + std::to_string(line[i]) + ": time_s: found " + NumberText(time_s[i]) +
                           ", " + RoundedText(1e6 * off) + " us off a grid of " +
                           RoundedText(1e6 * grid.period_s) + " us" + Advice(time_s, grid.period_s)});
    }
    squares += sum_of_squares - sum * sum / static_cast<double>(to - from);
  }
  const double scatter_s = std::sqrt(squares / static_cast<double>(time_s.size()));
  if (scatter_s > kMostScatter * grid.period_s)
    throw ConfigError({file + ": time_s: rows are " + RoundedText(1e6 * scatter_s) +
                       " us (root mean square) off a grid of " + RoundedText(1e6 * grid.period_s) + " us" +
                       Advice(time_s, grid.period_s)});
  return grid;
}

}  // namespace contour::diagnosis
