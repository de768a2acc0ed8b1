#include <algorithm>
#include <cmath>

#include "tools/diagnosis/forward_filter.h"

namespace contour::diagnosis {
namespace {

// First-order response to a constant command over a step, from and to a value.
struct Lag {
  double lag_s, value;
  double moment = 0.0;  // integral of (step/2 - t) u dt of the last step

  double Mean(double command, double step_s) {
    moment = 0.0;
    if (step_s <= 0.0) return value;
    if (lag_s < 1e-7) {
      value = command;
      return command;
    }
    const double x = step_s / lag_s;
    const double away = value - command;
    const double lost = -std::expm1(-x);
    value = command + away * (1.0 - lost);
    // Integral of t e^(-t/lag) is lag^2 (1 - (1 + x) e^-x).
    moment = away * lag_s * (0.5 * step_s * lost - lag_s * (lost - x * (1.0 - lost)));
    return command + away * lost / x;
  }
};

}  // namespace

Delivered DeliveredMeans(const AxisLog& log, double delay_s, double lag_s, int substeps) {
  const std::size_t n = log.size();
  const auto count = static_cast<std::size_t>(substeps);
  const double h = log.period_s / substeps;
  const double rows = std::max(0.0, delay_s) / log.period_s;
  const auto whole = static_cast<std::size_t>(rows);
  const double edge_s = (rows - static_cast<double>(whole)) * log.period_s;
  const auto edge_step = std::min(count - 1, static_cast<std::size_t>(edge_s / h));
  const double before_s = std::clamp(edge_s - static_cast<double>(edge_step) * h, 0.0, h);
  Delivered out;
  out.mean.resize(n * count);
  out.late.resize(n);
  Lag lag{std::max(0.0, lag_s), log.command.empty() ? 0.0 : log.command[0]};
  // Away from the edge all steps are alike: mean and moment per unit of what is away from the command.
  Lag unit{lag.lag_s, 1.0};
  const double mean_away = unit.Mean(0.0, h);
  const double moment_away = unit.moment, kept = unit.value;
  for (std::size_t k = 0; k < n; ++k) {
    const double now = log.command[k >= whole ? k - whole : 0];
    const double old = log.command[k >= whole + 1 ? k - whole - 1 : 0];
    double* mean = &out.mean[k * count];
    double late = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      if (j == edge_step) {
        const double rest_s = h - before_s;
        const double first = lag.Mean(old, before_s) * before_s;
        late += lag.moment + first * 0.5 * rest_s;
        const double rest = lag.Mean(now, rest_s) * rest_s;
        late += lag.moment - rest * 0.5 * before_s;
        mean[j] = (first + rest) / h;
        continue;
      }
      const double command = j < edge_step ? old : now;
      const double away = lag.value - command;
      mean[j] = command + away * mean_away;
      late += away * moment_away;
      lag.value = command + away * kept;
    }
    out.late[k] = late;
  }
  return out;
}

}  // namespace contour::diagnosis
