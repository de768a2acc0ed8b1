#include "analysis/diagnosis/screening/nominal.h"

#include <algorithm>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/screening/lag_for_delay.h"
#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"
#include "analysis/prediction_error/refit.h"

namespace contour::diagnosis {

Nominal FitNominal(Problem& problem) {
  Nominal nominal;
  Point start;
  for (const BaseTerm& t : problem.terms) start.base.push_back(t.start);
  problem.LearnOutliers(start);
  problem.LearnNoise(start);
  const Extent ahead = problem.excerpt.empty() ? Extent::kWhole : Extent::kExcerpt;
  nominal.fit = FitPoint(problem, start, kEfforts.quick, ahead);
  problem.LearnNoise(nominal.fit.point);
  if (ahead == Extent::kExcerpt) {
    nominal.fit =
        FitPoint(problem, FitPoint(problem, nominal.fit.point, kFits.to_the_basin, ahead).point, FitEffort{});
  } else {
    Rewhiten(problem, nominal.fit);
    nominal.fit = FitOn(problem, std::move(nominal.fit), FitEffort{});
  }
  // A resonance may have been taken for another one.
  FitFromStated(problem, nominal.fit, FitEffort{});
  if (AdmitCouplings(problem, nominal.fit)) nominal.fit = FitPoint(problem, nominal.fit.point, FitEffort{});
  // Not before: what the stated numbers are off by would pass for a torque that wanders.
  problem.slow_torque = Plausible(problem, nominal.fit.point);
  if (problem.slow_torque) {
    problem.LearnNoise(nominal.fit.point);
    nominal.fit = FitFrom(problem, std::move(nominal.fit), FitEffort{});
  }
  problem.LearnSignals(nominal.fit.point);
  nominal.catalogue = CatalogueEffects(problem);
  nominal.by_extras = std::max(0.0, problem.ExplainedByExtras(nominal.fit.point));
  return nominal;
}

}  // namespace contour::diagnosis
