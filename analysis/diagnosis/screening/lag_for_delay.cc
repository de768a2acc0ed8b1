#include "analysis/diagnosis/screening/lag_for_delay.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"

namespace contour::diagnosis {

double MostLagForDelay(const Problem& problem, const Point& point) {
  const double w = 2.0 * std::numbers::pi * NoFault_Hz(problem), lag_s = problem.Build(point).lag_s;
  return std::sqrt(lag_s * lag_s + 2.0 / (w * w)) - lag_s;
}

bool AdmitCouplings(Problem& problem, const Fit& fit) {
  const auto term = std::find_if(problem.terms.begin(), problem.terms.end(),
                                 [](const BaseTerm& t) { return t.name == "lag_for_delay"; });
  if (term == problem.terms.end()) return false;
  const double x = fit.point.base[static_cast<std::size_t>(term - problem.terms.begin())];
  if (std::fabs(x) < kFits.far_off_deviations * term->sigma) return false;
  // None, or all that is no fault within what numbers are off by.
  const double sigma = x < 0.0 ? kScreening.negligible_share * term->sigma
                               : MostLagForDelay(problem, fit.point) / kFits.far_off_deviations;
  if (x > 0.0 && sigma < term->sigma) return false;
  term->sigma = sigma;
  return true;
}

}  // namespace contour::diagnosis
