#include "analysis/diagnosis/screening/gross_sliding.h"

#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"

namespace contour::diagnosis {
std::vector<double> TravelSinceReversal(const Signals& s) {
  const Signal& x = s.table_m;
  std::vector<double> travel(x.size(), 0.0);
  double turned_at = x[0], furthest = x[0];
  bool up = true;
  auto begin = s.begins.begin();
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (begin != s.begins.end() && *begin == k) {
      turned_at = furthest = x[k];  // no motion led here
      ++begin;
    }
    if (up ? x[k] > furthest : x[k] < furthest) furthest = x[k];
    if (std::fabs(s.sign[k]) > kFollowsMotion && (s.sign[k] > 0.0) != up) {
      up = !up;
      turned_at = furthest;
      furthest = x[k];
    }
    travel[k] = std::fabs(x[k] - turned_at);
  }
  return travel;
}

bool FrictionModelMismatch(const Problem& problem, const Fit& fit) {
  const std::vector<SharedEffect>& effects = fit.point.effects;
  if (std::none_of(effects.begin(), effects.end(),
                   [](const SharedEffect& e) { return *CauseNamed(e->kind).takes_up_mismatch; }))
    return false;
  for (std::size_t i = 0; i < problem.terms.size(); ++i) {
    const BaseTerm& t = problem.terms[i];
    if (t.name == "rough" && fit.point.base[i] < -kMismatch.below_zero_deviations * t.sigma) return true;
  }
  return false;
}

std::vector<bool> GrossSliding(const Problem& problem) {
  const Signals& s = *problem.signals;
  const StatedFriction& f = problem.nominal.friction;
  const double far_m = kMismatch.gross_sliding_lengths * f.Fc_plus / f.s0 * problem.stated.table_per_q;
  const std::vector<double> travel = TravelSinceReversal(s);
  std::vector<bool> out(problem.rows());
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = problem.counted[k] != 0 && travel[k] > far_m && std::fabs(s.velocity[k]) > f.vs;
  return out;
}

double DropOf(const Problem& problem, const Fit& without, const Fit& with) {
  const std::string& kind = with.point.effects.back()->kind;
  if (!FrictionModelMismatch(problem, without) || CauseNamed(kind).acts_at_reversals || InBase(problem, kind))
    return without.cost - with.cost;
  const std::vector<bool> sliding = GrossSliding(problem);
  double drop = 0.0;
  for (std::size_t k = 0; k < with.residual.size(); ++k)
    if (k >= sliding.size() || sliding[k])
      drop += without.residual[k] * without.residual[k] - with.residual[k] * with.residual[k];
  return drop;
}

}  // namespace contour::diagnosis
