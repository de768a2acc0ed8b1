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

struct Instant {
  Point point;
  double squares = std::numeric_limits<double>::infinity();
};

/// In which the best of some instants lies.
struct Span_s {
  double low, high;

  [[nodiscard]] double At(int i) const { return low + (high - low) * i / kParts; }
  [[nodiscard]] double Part() const { return (high - low) / kParts; }

  static constexpr int kParts = 2 * kLanes;
};

/// The best of some instants all over a span and what is known of one; the other numbers as they are.
void TakeBest(const Problem& problem, const Span_s& span, std::span<const int> parts, Instant& best) {
  std::vector<Point> points;
  for (const int i : parts) {
    points.push_back(best.point);
    points.back().amplitudes.back()[kLater] = span.At(i);
  }
  const std::vector<std::vector<double>> residuals = problem.Residuals(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double squares = 0.0;
    for (const double r : residuals[i]) squares += r * r;
    if (squares < best.squares) best = {std::move(points[i]), squares};
  }
}

Point BestInstant(const Problem& problem, Point point) {
  const Effect& e = *point.effects.back();
  Span_s span{e.low[kLater], e.high[kLater]};
  Instant best{std::move(point)};
  for (bool whole = true; span.high - span.low > problem.log.period_s; whole = false) {
    const double known_s = best.point.amplitudes.back()[kLater];
    std::vector<int> parts;
    for (int i = 0; i <= Span_s::kParts; ++i) {
      // The ends of a part, and the best in it, were looked at before.
      const bool looked_at =
          i == 0 || i == Span_s::kParts || 2.0 * std::fabs(span.At(i) - known_s) < span.Part();
      if (whole || !looked_at) parts.push_back(i);
    }
    TakeBest(problem, span, parts, best);
    const double at_s = best.point.amplitudes.back()[kLater], next_s = span.Part();
    span = {std::max(span.low, at_s - next_s), std::min(span.high, at_s + next_s)};
  }
  return std::move(best.point);
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
