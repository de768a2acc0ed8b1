#include "analysis/diagnosis/decision/long_delays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/guesses.h"
#include "analysis/diagnosis/decision/tested_score.h"
#include "analysis/diagnosis/screening/full_size.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {
namespace {

/// One run of all lanes: as it is, and from one row on, each twice as late as the one before.
std::vector<Point> FromNoneOn(const Problem& problem, const Fit& current, const SharedEffect& effect) {
  std::vector<Point> points;
  for (int i = 0; i < kLanes; ++i) {
    points.push_back(current.point);
    points.back().effects.push_back(effect);
    points.back().amplitudes.push_back({i == 0 ? 0.0 : std::ldexp(problem.log.period_s, i - 1)});
  }
  return points;
}

/// A fit that began at none has come nearer to it than to none.
bool CameNear(std::span<const Hypothesis> hypotheses, const GridPoint& there) {
  const double seconds = there.point.amplitudes.back()[0];
  return std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& r) {
    return r.effect().kind == there.point.effects.back()->kind &&
           2.0 * r.fit.point.amplitudes.back()[0] > seconds;
  });
}

}  // namespace

std::vector<InitialGuess> LongDelays(const Problem& problem, const Fit& current,
                                     const std::vector<Scored>& scored, const ScoreThreshold& threshold,
                                     std::span<const Hypothesis> hypotheses) {
  std::vector<InitialGuess> guesses;
  for (const Scored& s : scored) {
    if (!CauseNamed(s.effect->kind).about_timing) continue;
    std::vector<GridPoint> late = RoughCosts(problem, current, FromNoneOn(problem, current, s.effect));
    if (late.size() < 2 || late[0].point.amplitudes.back()[0] > 0.0) continue;
    const auto best = std::min_element(
        late.begin(), late.end(), [](const GridPoint& a, const GridPoint& b) { return a.cost < b.cost; });
    Scored there = s;
    there.drop = late[0].cost - best->cost;
    if (!Promising(problem, there, threshold) || CameNear(hypotheses, *best)) continue;
    FitEffort effort = WorthFrom(current, kEfforts.far, kScreening.negligible_share);
    effort.hopeless_above = current.cost;
    guesses.push_back({std::move(best->point), effort, &current});
  }
  return guesses;
}

}  // namespace contour::diagnosis
