#include "analysis/diagnosis/decision/same_timing.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/tested_score.h"
#include "analysis/diagnosis/screening/lag_for_delay.h"

namespace contour::diagnosis {
namespace {

/// The score that a hypothesis has where such a coupling is not held against it; none where the model has
/// one.
double ScoreWithACoupling(const Problem& problem, const Hypothesis& r) {
  for (std::size_t i = 0; i < problem.terms.size(); ++i) {
    if (problem.terms[i].name != "lag_for_delay") continue;
    const auto at = static_cast<Eigen::Index>(i);
    const double variance = problem.terms[i].sigma * problem.terms[i].sigma, x = r.fit.point.base[i];
    const double free = 1.0 - r.fit.covariance(at, at) / variance, to = x / free;
    const bool such = free > 0.0 && to > 0.0 && to < MostLagForDelay(problem, r.fit.point);
    return such ? r.score + x * to / variance : r.score;
  }
  return -std::numeric_limits<double>::infinity();
}

}  // namespace

bool SameTiming(const Problem& problem, const Hypothesis& best, const Hypothesis& r, double alike) {
  const CauseDefinition& cause = CauseNamed(best.effect().kind);
  if (!CauseNamed(r.effect().kind).about_timing || !(cause.about_timing || AddsCoupling(problem, best)))
    return false;
  // Where the best pays for such an exchange as well, it is not held against it either.
  return ScoreWithACoupling(problem, r) > std::max(best.score, ScoreWithACoupling(problem, best)) - alike;
}

}  // namespace contour::diagnosis
