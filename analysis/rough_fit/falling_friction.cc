#include "analysis/rough_fit/falling_friction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/prediction_error/fit.h"
#include "analysis/prediction_error/noise_levels.h"
#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {
namespace {

/// Break-away over Coulomb level from which a fit begins, and relative deviations of both numbers.
constexpr double kBreakAway = 1.1, kLevelSigma = 0.5, kWideSigma = 1.0;
/// Of a bristle's damping, over the critical one: what the axis does as it breaks away goes by it, too.
constexpr double kBristleDamping = 0.5;
/// [-2 log likelihood] That three more numbers win by chance (Akaike).
constexpr double kByChance = 6.0;

/// Break-away over Coulomb level from which there is a curve to speak of.
constexpr double kLeastRatio = 1.05;
constexpr FitEffort kFar = {.most_steps = 8, .most_refreshes = 2, .close_enough = 1.0, .covariance = false};
constexpr FitEffort kQuick = {.most_steps = 3, .most_refreshes = 1, .close_enough = 1.0, .covariance = false};

struct Judged {
  double unlikeliness = std::numeric_limits<double>::infinity();  ///< -2 log likelihood, up to a constant
  bool falls = false;
};

Judged Judge(const AxisLog& log, const StatedAxis& stated) {
  Problem problem(log, stated, 1);
  Point point;
  for (const BaseTerm& t : problem.terms) point.base.push_back(t.start);
  problem.LearnOutliers(point);
  problem.LearnNoise(point);
  const Extent ahead = problem.excerpt.empty() ? Extent::kWhole : Extent::kExcerpt;
  for (int turn = 0; turn < 2; ++turn) {
    point = FitPoint(problem, point, kFar, ahead).point;
    problem.LearnNoise(point);
  }
  const Fit fit = FitPoint(problem, std::move(point), kQuick);
  const StatedFriction f = problem.Build(fit.point).friction;
  return {fit.cost + problem.LogNoise(), f.Fs_plus + f.Fs_minus > kLeastRatio * (f.Fc_plus + f.Fc_minus)};
}

StatedAxis Falling(const StatedAxis& flat, double exponent) {
  StatedAxis axis = flat;
  StatedFriction& f = axis.friction;
  f.exponent = exponent;
  f.Fs_plus *= kBreakAway;
  f.Fs_minus *= kBreakAway;
  axis.sigma["Fs"] = kLevelSigma;
  axis.sigma["vs"] = kWideSigma;
  if (!axis.open.contains("s0") || f.s1 > 0.0) return axis;
  const double inertia = axis.motor_inertia + (axis.friction_on_load ? 0.0 : axis.load_inertia);
  f.s1 = 2.0 * kBristleDamping * std::sqrt(f.s0 * inertia);
  axis.sigma["s1"] = kWideSigma;
  return axis;
}

}  // namespace

void OpenFallingFriction(const AxisLog& log, StatedAxis& stated) {
  const auto there = std::count(log.present.begin(), log.present.end(), std::uint8_t{1});
  if (there < static_cast<std::ptrdiff_t>(FewestRowsOfLevels())) return;
  double least = Judge(log, stated).unlikeliness - kByChance;
  const StatedAxis flat = stated;
  std::vector<double> exponents = {stated.friction.exponent};
  if (stated.open.contains("exponent")) exponents = {1.0, 2.0};
  for (const double exponent : exponents) {
    StatedAxis falling = Falling(flat, exponent);
    const Judged judged = Judge(log, falling);
    // One that rises with the speed is viscous friction of another kind.
    if (!judged.falls || judged.unlikeliness >= least) continue;
    least = judged.unlikeliness;
    stated = std::move(falling);
  }
}

}  // namespace contour::diagnosis
