#include <algorithm>
#include <cmath>

#include <span>

#include "analysis/prediction_error/forward_filter.h"

namespace contour::diagnosis {
namespace {

// First-order response over a step under a constant command, per unit of what the current is away from it:
// mean, integral of (step / 2 - t) u dt, and what is left.
struct Step {
  double mean = 0.0, moment = 0.0, kept = 0.0;
};

Step StepOver(double step_s, double lag_s) {
  if (step_s <= 0.0) return {1.0, 0.0, 1.0};
  if (lag_s < 1e-7) return {};
  const double x = step_s / lag_s;
  const double lost = -std::expm1(-x);
  // Integral of t e^(-t/lag) is lag^2 (1 - (1 + x) e^-x).
  return {lost / x, lag_s * (0.5 * step_s * lost - lag_s * (lost - x * (1.0 - lost))), 1.0 - lost};
}

constexpr double kForgotten = 30.0;  // lags

}  // namespace

Delivered DeliveredMeans(const AxisLog& log, double delay_s, double lag_s, int substeps) {
  Delivered out;
  DeliveredMeans(log, delay_s, lag_s, substeps, {}, out);
  return out;
}

void DeliveredMeans(const AxisLog& log, double delay_s, double lag_s, int substeps,
                    std::span<const Segment> segments, Delivered& out) {
  const auto count = static_cast<std::size_t>(substeps);
  const double h = log.period_s / substeps;
  const double rows = std::max(0.0, delay_s) / log.period_s;
  const auto whole = static_cast<std::size_t>(rows);
  const double edge_s = (rows - static_cast<double>(whole)) * log.period_s;
  const auto edge_step = std::min(count - 1, static_cast<std::size_t>(edge_s / h));
  const double before_s = std::clamp(edge_s - static_cast<double>(edge_step) * h, 0.0, h);
  const double lag = std::max(0.0, lag_s), rest_s = h - before_s;
  const Step whole_step = StepOver(h, lag), first_part = StepOver(before_s, lag),
             rest_part = StepOver(rest_s, lag);
  // Away from the edge all steps are alike.
  std::vector<double> mean_after(count), kept_after(count + 1, 1.0);
  for (std::size_t j = 0; j < count; ++j) {
    mean_after[j] = whole_step.mean * kept_after[j];
    kept_after[j + 1] = whole_step.kept * kept_after[j];
  }
  std::vector<double> late_after(count);
  for (std::size_t j = 0; j < count; ++j) late_after[j] = whole_step.moment * kept_after[j];
  const std::size_t rest = count - 1 - edge_step;
  double value = 0.0;
  const auto over = [&](std::size_t k, double* mean, double* late) {
    const double now = log.command[k >= whole ? k - whole : 0];
    const double old = log.command[k >= whole + 1 ? k - whole - 1 : 0];
    double away = value - old;
    for (std::size_t j = 0; j < edge_step; ++j) {
      mean[j] = old + away * mean_after[j];
      late[j] = away * late_after[j];
    }
    away *= kept_after[edge_step];
    const double first = (old + away * first_part.mean) * before_s;
    late[edge_step] = away * first_part.moment + first * 0.5 * rest_s;
    away = old + away * first_part.kept - now;
    const double second = (now + away * rest_part.mean) * rest_s;
    late[edge_step] += away * rest_part.moment - second * 0.5 * before_s;
    mean[edge_step] = (first + second) / h;
    away *= rest_part.kept;
    for (std::size_t j = 0; j < rest; ++j) {
      mean[edge_step + 1 + j] = now + away * mean_after[j];
      late[edge_step + 1 + j] = away * late_after[j];
    }
    value = now + away * kept_after[rest];
  };
  const Segment all{.rows = log.size()};
  if (segments.empty()) segments = std::span(&all, 1);
  const std::size_t kept = segments.back().at + segments.back().rows;
  out.mean.resize(kept * count);
  out.late.resize(kept * count);
  // A lag forgets within some of its lengths.
  const std::size_t before = 1 + static_cast<std::size_t>(kForgotten * lag / log.period_s);
  std::vector<double> spare(2 * count);
  for (const Segment& s : segments) {
    const std::size_t begin = s.from > before ? s.from - before : 0;
    value = log.command[begin >= whole + 1 ? begin - whole - 1 : 0];
    for (std::size_t k = begin; k < s.from; ++k) over(k, spare.data(), &spare[count]);
    for (std::size_t i = 0; i < s.rows; ++i)
      over(s.from + i, &out.mean[(s.at + i) * count], &out.late[(s.at + i) * count]);
  }
}

}  // namespace contour::diagnosis
