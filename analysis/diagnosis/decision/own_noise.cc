#include "analysis/diagnosis/decision/own_noise.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/refit.h"

namespace contour::diagnosis {
namespace {

struct UnderOwnNoise {
  Fit fit;
  double unlikely = std::numeric_limits<double>::infinity();  ///< -2 log likelihood, its noise included
};

/// Fit and noise in turn, while that gains what no chance does. `first`: what is learnt where it begins. One
/// that under its own noise is further behind `best` than chance, or would be by what its fit promises, goes
/// no further.
UnderOwnNoise FitUnderOwnNoise(Problem& problem, const Fit& begin, double best, LearntNoise* first) {
  const double penalty = Penalty(*begin.point.effects.back());
  const double behind = best + kAcceptance.no_chance_score;
  UnderOwnNoise out;
  for (int turn = 0; turn < FitEffort{}.most_refreshes; ++turn) {
    Fit fit = turn == 0 ? begin : out.fit;
    problem.LearnNoise(fit.point);
    if (turn == 0 && first != nullptr) *first = problem.Learnt();
    Rewhiten(problem, fit);
    const double before = fit.cost, beyond_fit = problem.LogNoise() + penalty;
    FitEffort effort = kEfforts.quick;
    effort.hopeless_above = behind - beyond_fit;
    fit = FitOn(problem, std::move(fit), effort);
    const double unlikely = fit.cost + beyond_fit;
    const double gained = out.unlikely - unlikely;
    if (!(gained > 0.0)) break;
    // Where the fit hardly moves its noise is learnt.
    const bool moved = before - fit.cost > penalty;
    out = {std::move(fit), unlikely};
    if (!moved || gained < kAcceptance.no_chance_score || unlikely > behind) break;
  }
  return out;
}

/// The best, and those near it under the noise that there was. What lies outside the catalogue follows any
/// noise.
std::vector<std::size_t> Contenders(const std::vector<Hypothesis>& hypotheses) {
  std::vector<std::size_t> out;
  const double least =
      (1.0 - kHypotheses.may_matter_share) * hypotheses[0].score - kHypotheses.new_noise_score;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const Hypothesis& h = hypotheses[i];
    if (!h.given_up && !h.no_fault && !Outside(h.effect().kind) && h.score > least) out.push_back(i);
  }
  return out;
}

}  // namespace

void LearnNoiseOfLikeliest(Problem& problem, std::vector<Hypothesis>& hypotheses) {
  const std::vector<std::size_t> contenders = Contenders(hypotheses);
  if (contenders.size() < 2 || contenders[0] != 0) return problem.LearnNoise(hypotheses[0].fit.point);
  const NoiseFilter before = problem.noise;
  LearntNoise at_first;
  std::size_t likeliest = 0;
  UnderOwnNoise best;
  for (const std::size_t i : contenders) {
    UnderOwnNoise own =
        FitUnderOwnNoise(problem, hypotheses[i].fit, best.unlikely, i == 0 ? &at_first : nullptr);
    // Less is a matter of where the noise's own fit ends.
    if (i > 0 && !(own.unlikely < best.unlikely - kAcceptance.no_chance_score)) continue;
    best = std::move(own);
    likeliest = i;
  }
  // Where the best is the likeliest nothing is to change, and its noise is learnt.
  if (likeliest == 0) return problem.Take(std::move(at_first));
  problem.noise = before;
  hypotheses[likeliest].fit = std::move(best.fit);
  problem.LearnNoise(hypotheses[likeliest].fit.point);
  std::rotate(hypotheses.begin(), hypotheses.begin() + static_cast<std::ptrdiff_t>(likeliest),
              hypotheses.begin() + static_cast<std::ptrdiff_t>(likeliest) + 1);
}

}  // namespace contour::diagnosis
