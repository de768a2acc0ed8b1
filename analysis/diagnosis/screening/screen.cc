#include "analysis/diagnosis/screening/screen.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/screening/gross_sliding.h"

namespace contour::diagnosis {
std::vector<Scored> Screen(const Problem& problem, const Fit& fit, std::span<const SharedEffect> catalogue) {
  std::vector<SharedEffect> effects(catalogue.begin(), catalogue.end());
  for (SharedEffect& e : ScanWaves(problem, fit)) effects.push_back(std::move(e));
  // Numbers of a law of friction that does not hold are no cause when they are not as stated, and where
  // friction is not what the law says is no matter of time.
  const bool mismatch = FrictionModelMismatch(problem, fit);
  std::erase_if(effects, [&](const SharedEffect& e) {
    if (mismatch && CauseNamed(e->kind).refuted_by_mismatch) return true;
    return std::any_of(fit.point.effects.begin(), fit.point.effects.end(), [&](const SharedEffect& f) {
      // A wave may have further orders.
      const bool another = e->wave && f->wave && std::fabs(e->order - f->order) > kScan.waves_apart;
      return f->kind == e->kind && !another;
    });
  });
  std::vector<Scored> scored = ScoreEffects(problem, fit, std::move(effects));
  std::stable_sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) {
    return a.drop - Penalty(*a.effect) > b.drop - Penalty(*b.effect);
  });
  return scored;
}

}  // namespace contour::diagnosis
