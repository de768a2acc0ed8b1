#include "analysis/prediction_error/fitted_half.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/prediction_error/refit.h"

namespace contour::diagnosis {
namespace {

/// The halves are near the whole; what they are for is a forecast, and how far they are apart.
constexpr FitEffort kHalfEffort = {
    .most_steps = 6, .most_refreshes = 2, .close_enough = 1.0, .covariance = false};

}  // namespace

std::size_t PartBegin(const Problem& problem, std::size_t part) { return problem.rows() * part / kHalfParts; }

std::array<Point, 2> FitHalves(const Problem& problem, const Fit& fit) {
  const std::size_t n = problem.rows();
  std::array<Problem, 2> seen = {problem, problem};
  std::array<Fit, 2> whole = {fit, fit};
  std::vector<InitialGuess> guesses;
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t part = 1 - half; part < kHalfParts; part += 2)
      for (std::size_t k = PartBegin(problem, part); k < PartBegin(problem, part + 1); ++k) {
        seen[half].counted[k] = 0;
        for (std::size_t channel = k; channel < seen[half].root_weight.size(); channel += n)
          seen[half].root_weight[channel] = 0.0;
      }
    // The runs of the whole serve either half.
    Rewhiten(seen[half], whole[half]);
    guesses.push_back({fit.point, kHalfEffort, nullptr, &whole[half], &seen[half]});
  }
  std::vector<Fit> fits = FitPoints(problem, std::move(guesses));
  return {std::move(fits[0].point), std::move(fits[1].point)};
}

StatedAxis FittedAxis(const Problem& problem, const Fit& fit, const std::array<Point, 2>& halves) {
  Point base = fit.point;
  base.effects.clear();
  base.amplitudes.clear();
  AxisModel m = problem.Build(base);
  StatedAxis axis = problem.stated;
  axis.motor_inertia = m.motor_inertia;
  axis.load_inertia = m.load_inertia;
  axis.stiffness = m.stiffness;
  axis.damping = m.damping;
  axis.friction = m.friction;
  axis.offset = m.offset;
  axis.delay_s = m.delay_s;
  axis.lag_s = m.lag_s;
  // Noise that goes on for long scatters more from part to part of the log than the fit's covariance says.
  for (std::size_t i = 0; i < problem.terms.size(); ++i) {
    const BaseTerm& t = problem.terms[i];
    const auto at = static_cast<Eigen::Index>(i);
    const double value = std::fabs(*t.field(m));
    if (t.nuisance || !(value > 0.0)) continue;
    const double sd = std::max(std::sqrt(std::max(0.0, fit.covariance(at, at))),
                               0.5 * std::fabs(halves[0].base[i] - halves[1].base[i]));
    axis.sigma[t.name] = t.additive ? sd / value : sd;
  }
  return axis;
}

}  // namespace contour::diagnosis
