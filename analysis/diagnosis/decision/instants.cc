#include "analysis/diagnosis/decision/instants.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "analysis/diagnosis/decision/guesses.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {
namespace {

/// Of the amplitudes of an effect that begins at a row: its size, then how much later it begins.
constexpr std::size_t kLater = 1;

bool BeginsAtInstant(const Effect& e) {
  return e.from_row > 0 && e.steps.size() == kLater + 1 && e.low.size() > kLater;
}

/// The best of some instants all over a span, the other numbers as they are.
Point BestWithin(const Problem& problem, const Point& from, double low_s, double high_s) {
  constexpr int kCount = 2 * kLanes;
  std::vector<Point> points;
  for (int i = 0; i <= kCount; ++i) {
    points.push_back(from);
    points.back().amplitudes.back()[kLater] = low_s + (high_s - low_s) * i / kCount;
  }
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<double>> residuals = problem.Residuals(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double squares = 0.0;
    for (const double r : residuals[i]) squares += r * r;
    if (squares < least) {
      least = squares;
      best = i;
    }
  }
  return std::move(points[best]);
}

Point BestInstant(const Problem& problem, Point point) {
  const Effect& e = *point.effects.back();
  double low_s = e.low[kLater], high_s = e.high[kLater];
  while (high_s - low_s > problem.log.period_s) {
    point = BestWithin(problem, point, low_s, high_s);
    const double at_s = point.amplitudes.back()[kLater], next_s = (high_s - low_s) / (2 * kLanes);
    low_s = std::max(low_s, at_s - next_s);
    high_s = std::min(high_s, at_s + next_s);
  }
  return point;
}

}  // namespace

std::vector<InitialGuess> OtherInstants(const Problem& problem, const Fit& current,
                                        std::span<const Hypothesis> hypotheses) {
  std::vector<InitialGuess> guesses;
  for (const Hypothesis& r : hypotheses) {
    if (!BeginsAtInstant(r.effect()) || !std::isfinite(r.fit.cost)) continue;
    Point best = BestInstant(problem, r.fit.point);
    const double moved_s = std::fabs(best.amplitudes.back()[kLater] - r.fit.point.amplitudes.back()[kLater]);
    if (moved_s < problem.log.period_s) continue;
    guesses.push_back({std::move(best), WorthFrom(current, kEfforts.quick, kScreening.negligible_share)});
  }
  return guesses;
}

}  // namespace contour::diagnosis
