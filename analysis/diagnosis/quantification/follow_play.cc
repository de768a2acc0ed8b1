#include "analysis/diagnosis/quantification/follow_play.h"

#include <cmath>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/parameters.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

void FollowPlay(Problem& problem, Accepted& accepted, Fit& nominal) {
  if (accepted.places.empty() || !(problem.Build(accepted.fit.point).gap > 0.0)) return;
  // Where friction is not the model's, what it does passes for noise of the torque, and the reading would be
  // all that is believed.
  for (const SharedEffect& e : accepted.fit.point.effects)
    if (CauseNamed(e->kind).takes_up_mismatch) return;
  const FilterSetup slow = problem.setup;
  LearntNoise slow_noise = problem.Learnt();
  problem.FollowReading(accepted.fit.point);
  Fit fit = FitPoint(problem, accepted.fit.point, kEfforts.quick);
  double unlikely = fit.cost + problem.LogNoise();
  // A residual that stands out where a play was too narrow passed for noise: fit and noise in turn, while
  // that gains what no chance does.
  for (int turn = 1; turn < FitEffort{}.most_refreshes; ++turn) {
    Problem again = problem;
    again.LearnNoise(fit.point);
    Fit other = FitPoint(again, fit.point, kEfforts.quick);
    const double now = other.cost + again.LogNoise();
    if (!(now < unlikely - kAcceptance.no_chance_score)) break;
    unlikely = now;
    fit = std::move(other);
    problem.LearnNoise(fit.point);
  }
  std::vector<Fit> fits =
      FitPoints(problem, {{std::move(fit.point), kEfforts.quick}, {nominal.point, kEfforts.quick}});
  if (!(problem.Build(fits[0].point).gap > 0.0)) {
    // Nothing of it shows behind the quicker observer, which is no size either: the slow one's stands.
    problem.setup = slow;
    problem.Take(std::move(slow_noise));
    accepted.play_is_bound = true;
    return;
  }
  accepted.by_slow_observer = accepted.fit.point;
  accepted.fit = std::move(fits[0]);
  nominal = std::move(fits[1]);
}

void WidenByObserver(const Problem& problem, const Accepted& accepted, std::size_t place, Cause& cause) {
  const Point& slow = accepted.by_slow_observer;
  if (slow.effects.empty()) return;
  for (const auto& [name, value] : (*CauseNamed(cause.kind).parameters)({problem, slow, place})) {
    Interval& interval = cause.parameters.at(name);
    const double by = value - interval.value;
    interval.low = interval.value - std::hypot(interval.value - interval.low, by);
    interval.high = interval.value + std::hypot(interval.high - interval.value, by);
  }
}

}  // namespace contour::diagnosis
