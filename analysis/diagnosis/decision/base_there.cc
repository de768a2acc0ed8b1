#include "analysis/diagnosis/decision/base_there.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {

Point Without(const Problem& problem, Point point, std::size_t place) {
  const std::vector<std::size_t> freed = FreedTerms(problem, point.effects[place]->kind);
  const std::vector<double>& amplitudes = point.amplitudes[place];
  for (std::size_t i = 0; i < std::min(freed.size(), amplitudes.size()); ++i)
    point.base[freed[i]] += amplitudes[i];
  const auto at = static_cast<std::ptrdiff_t>(place);
  point.effects.erase(point.effects.begin() + at);
  point.amplitudes.erase(point.amplitudes.begin() + at);
  return point;
}

Point WithoutLast(const Problem& problem, Point point) {
  const std::size_t last = point.effects.size() - 1;
  return Without(problem, std::move(point), last);
}

bool MayLieLower(const Fit& there, const Fit& here, double enough, double lost) {
  return there.cost - there.promised < here.cost - enough || !(there.cost < here.cost + lost);
}

bool BaseLiesThere(const Problem& problem, const Hypothesis& r, const FitEffort& effort, Fit& current) {
  const double drop = current.cost - r.fit.cost;
  if (!(drop > 0.0)) return false;
  Fit there = FitPoint(problem, WithoutLast(problem, r.fit.point), effort);
  if (!(current.cost - there.cost > kHypotheses.half_share * drop)) return false;
  current = std::move(there);
  return true;
}

}  // namespace contour::diagnosis
