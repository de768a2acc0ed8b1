#include "analysis/recording/grid.h"

#include <algorithm>
#include <cmath>

#include "config/config_error.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// A table that states 1 ms to six digits means 1 ms.
double Rounded(double period_s) {
  const double whole_us = std::round(period_s * 1e6) * 1e-6;
  return whole_us > 0.0 && std::abs(period_s - whole_us) < 1e-6 * whole_us ? whole_us : period_s;
}

}  // namespace

Grid FindGrid(const std::string& file, const std::vector<double>& time_s,
              const std::vector<std::size_t>& line) {
  if (time_s.size() < 3) throw ConfigError({file + ": has fewer than three rows"});
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double step = time_s[i] - time_s[i - 1];
    if (!(step > 0.0))
      throw ConfigError({file + ":" + std::to_string(line[i]) + ": time_s: found " + NumberText(time_s[i]) +
                         " after " + NumberText(time_s[i - 1]) + ", expected time to go on"});
    steps.push_back(step);
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double median = *middle;

  Grid grid;
  grid.index.assign(time_s.size(), 0);
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double steps_on = std::round((time_s[i] - time_s[i - 1]) / median);
    if (steps_on < 1.0)
      throw ConfigError({file + ":" + std::to_string(line[i]) + ": time_s: found " + NumberText(time_s[i]) +
                         ", " + RoundedText(1e6 * (time_s[i] - time_s[i - 1])) +
                         " us after the row before, expected " + RoundedText(1e6 * median)});
    grid.index[i] = grid.index[i - 1] + static_cast<std::size_t>(steps_on);
  }
  grid.period_s = Rounded((time_s.back() - time_s.front()) / static_cast<double>(grid.index.back()));
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double off = time_s[i] - time_s.front() - grid.period_s * static_cast<double>(grid.index[i]);
    if (std::abs(off) > 0.25 * grid.period_s)
      throw ConfigError({file + ":" + std::to_string(line[i]) + ": time_s: found " + NumberText(time_s[i]) +
                         ", " + RoundedText(1e6 * off) + " us off a grid of " +
                         RoundedText(1e6 * grid.period_s) +
                         " us: rows must be a fixed time apart, though some may be missing"});
  }
  return grid;
}

}  // namespace contour::diagnosis
