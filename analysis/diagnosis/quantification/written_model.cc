#include "analysis/diagnosis/quantification/written_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/parameters.h"
#include "analysis/diagnosis/quantification/model_errors.h"
#include "analysis/diagnosis/quantification/stated_off.h"
#include "analysis/diagnosis/quantification/widen.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/fitted_half.h"
#include "analysis/prediction_error/free_run_fit.h"

namespace contour::diagnosis {
namespace {

/// Without shapes from outside the catalogue, which no file holds: what they took is shared out anew.
Fit KnownAlone(const Problem& problem, Fit fit) {
  Point known = fit.point;
  known.effects.clear();
  known.amplitudes.clear();
  for (std::size_t e = 0; e < fit.point.effects.size(); ++e) {
    if (Outside(fit.point.effects[e]->kind)) continue;
    known.effects.push_back(fit.point.effects[e]);
    known.amplitudes.push_back(fit.point.amplitudes[e]);
  }
  if (known.effects.size() == fit.point.effects.size()) return fit;
  return FitPoint(problem, std::move(known), FitEffort{});
}

/// What changed with time has come to its end: that is the axis as it is now. No file holds how it got there.
void TakeEndOfDrift(const Problem& problem, const Fit& fit, StatedAxis& axis,
                    std::vector<std::string>& notes) {
  Point timed = fit.point, base = fit.point;
  base.effects.clear();
  base.amplitudes.clear();
  timed.effects.clear();
  timed.amplitudes.clear();
  // Only what explains most; a small drift may as well be something else.
  if (fit.point.effects.empty() || CauseNamed(fit.point.effects[0]->kind).extension != nullptr) return;
  timed.effects.push_back(fit.point.effects[0]);
  timed.amplitudes.push_back(fit.point.amplitudes[0]);
  const AxisModel with = problem.Build(timed), without = problem.Build(base);
  const auto end = [&](const SharedSignal& share) {
    double sum = 0.0;
    const auto rows = std::min(problem.rows(), static_cast<std::size_t>(1.0 / problem.log.period_s));
    for (std::size_t k = problem.rows() - rows; k < problem.rows() && share; ++k) sum += (*share)[k];
    return 1.0 + sum / static_cast<double>(rows);
  };
  const double factor = end(with.level) / end(without.level);
  const double viscous = end(with.viscous) / end(without.viscous);
  StatedFriction& f = axis.friction;
  for (double* level : {&f.Fc_plus, &f.Fc_minus, &f.Fs_plus, &f.Fs_minus}) *level *= factor;
  f.s2 *= viscous;
  (axis.two_inertia ? axis.load_inertia : axis.motor_inertia) += with.payload;
  if (factor == 1.0 && viscous == 1.0 && with.payload == 0.0) return;
  notes.emplace_back(
      "What changed while the log was recorded stands in the extended model as it was in the log's last "
      "second.");
}

/// How far free runs may move each parameter: numbers of the model within what is stated of them, sizes of
/// causes within their own scatter. What no file holds stays.
Eigen::VectorXd FreedomOf(const Problem& problem, const Fit& fit, const Accepted& accepted) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(fit.covariance.rows());
  Eigen::Index at = 0;
  for (const BaseTerm& t : problem.terms) out(at++) = t.nuisance ? 0.0 : t.sigma;
  for (std::size_t e = 0; e < fit.point.effects.size(); ++e) {
    const auto place = std::find(accepted.places.begin(), accepted.places.end(), e);
    const bool known = place != accepted.places.end() && fit.point.effects.size() == accepted.places.size();
    const double scatter =
        known ? accepted.scatter[static_cast<std::size_t>(place - accepted.places.begin())] : 1.0;
    for (std::size_t i = 0; i < fit.point.amplitudes[e].size(); ++i, ++at)
      out(at) = kAcceptance.few_strokes * std::sqrt(scatter * std::max(0.0, fit.covariance(at, at)));
  }
  return out;
}

/// Free runs by either half, of what it has not seen.
ForecastError Extended(const Problem& problem, const Fit& fit, const std::array<Point, 2>& halves) {
  const Forecast forecast{fit.point.effects.empty() ? "refitted" : "extended", fit.point, halves};
  return ErrorsOf(problem, std::span(&forecast, 1))[0];
}

/// The same model by its free runs, where they foresee clearly better.
bool TakeFreeRuns(const Problem& problem, const Accepted& accepted, Fit& fit, std::array<Point, 2>& halves,
                  Diagnosis& out) {
  if (out.model_errors.empty()) return false;
  const Eigen::VectorXd freedom = FreedomOf(problem, fit, accepted);
  Fit free = fit;
  free.point = FitFreeRuns(problem, fit.point, freedom, Parts::kAll);
  const std::array<Point, 2> by_half = {FitFreeRuns(problem, halves[0], freedom, Parts::kEven),
                                        FitFreeRuns(problem, halves[1], freedom, Parts::kOdd)};
  const ForecastError errors = Extended(problem, free, by_half);
  ForecastError& now = out.model_errors.back();
  if (!(errors.free_run_unseen < (1.0 - kScreening.little_share) * now.free_run_unseen)) return false;
  now = errors;
  fit = std::move(free);
  halves = by_half;
  return true;
}

/// Sizes as they go into the file.
void DescribeSizes(const Problem& problem, const Fit& fit, const Accepted& accepted, Diagnosis& out) {
  std::size_t index = 0;
  for (Cause& cause : out.in_model) {
    if (CauseNamed(cause.kind).in_scatter_only) continue;  // not in the fit
    Fit scattered = fit;
    scattered.covariance *= accepted.scatter[index];
    cause.shapes.clear();
    DescribeEffect(problem, scattered, accepted.places[index++], cause);
    WidenIntervals(problem, fit.point, cause);
  }
}

}  // namespace

void DescribeModel(const Problem& problem, const Fit& nominal, const Fit& all, const Accepted& accepted,
                   bool something_left, Diagnosis& out) {
  Fit fit = KnownAlone(problem, all);
  std::array<Point, 2> halves = FitHalves(problem, fit);
  DescribeModelErrors(problem, nominal, fit, halves, out);
  out.in_model = out.causes;
  // Where nothing is left, one-step errors say all that there is to know.
  if (something_left && TakeFreeRuns(problem, accepted, fit, halves, out)) {
    if (fit.point.effects.size() == all.point.effects.size()) DescribeSizes(problem, fit, accepted, out);
    out.notes.emplace_back(
        "The model is not complete, so the numbers in its file are those that foresee free runs best: they "
        "do so on parts of the log that they were not fitted on. The sizes told above are of one-step "
        "errors.");
  }
  std::erase_if(out.in_model, [](const Cause& c) { return Outside(c.kind); });
  out.fitted = FittedAxis(problem, fit, halves);
  TakeEndOfDrift(problem, fit, *out.fitted, out.notes);
  TellStatedOff(problem, fit.point, out);
  TellModelErrors(problem, out);
}

}  // namespace contour::diagnosis
