#include "analysis/diagnosis/decision/same_levels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/base_there.h"
#include "analysis/diagnosis/decision/chi_square.h"
#include "analysis/diagnosis/decision/held_out.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {
namespace {

/// The torque that either direction has in addition to the mean of both.
double OfDirections(const AxisModel& m) {
  return m.offset + (m.friction.Fc_minus - m.friction.Fc_plus) / 2.0;
}

double SquaresOf(const Fit& fit) {
  return std::inner_product(fit.residual.begin(), fit.residual.end(), fit.residual.begin(), 0.0);
}

Point Exchanged(const Problem& problem, const Point& point, const SharedEffect& by) {
  const Point without = WithoutLast(problem, point);
  Point out = without;
  out.effects.push_back(by);
  out.amplitudes.push_back(by->steps);
  const double none = OfDirections(problem.Build(without));
  const double per_step = OfDirections(problem.Build(out)) - none;
  double& amplitude = out.amplitudes.back()[0];
  amplitude *= (OfDirections(problem.Build(point)) - none) / per_step;
  if (!by->low.empty()) amplitude = std::clamp(amplitude, by->low[0], by->high[0]);
  return out;
}

}  // namespace

bool SameLevels(const Problem& problem, const Fit& fit, std::string_view other, double rate) {
  const std::string& kind = fit.point.effects.back()->kind;
  if (!SameInSliding(kind, other) || InBase(problem, kind) || InBase(problem, std::string(other)))
    return false;
  std::vector<SharedEffect> effects;
  (*CauseNamed(other).grid)(problem, effects);
  Fit exchanged;
  exchanged.point = Exchanged(problem, fit.point, effects[0]);
  exchanged.residual = std::move(problem.Residuals(std::span(&exchanged.point, 1))[0]);
  if (SquaresOf(exchanged) - SquaresOf(fit) <= AlikeScore()) return true;
  const double gained = Consistency(problem, exchanged, fit, LeftOut::kNothing);
  // Over the root of the sum of squares about the mean, in place of the sum of squares.
  const double about_mean = std::max(0.0, 1.0 - gained * gained / static_cast<double>(kBlocks));
  return gained <= std::sqrt(ChiSquareQuantile(1, rate) * about_mean);
}

}  // namespace contour::diagnosis
