#include "analysis/diagnosis/quantification/quantify.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/parameters.h"
#include "analysis/diagnosis/decision/residual_trace.h"
#include "analysis/diagnosis/quantification/model_errors.h"
#include "analysis/diagnosis/quantification/widen.h"
#include "analysis/diagnosis/tuning/fit_effort.h"
#include "analysis/prediction_error/bootstrap.h"
#include "analysis/prediction_error/fitted_half.h"
#include "analysis/prediction_error/refit.h"

namespace contour::diagnosis {
namespace {

/// Intervals of all that was accepted, from the fit of all of it.
void Bootstrap(const Problem& problem, const Accepted& accepted, Fit fit, const DiagnoseOptions& options,
               Diagnosis& out) {
  const Eigen::MatrixXd draws =
      StrokeBootstrap(problem, fit, options.bootstrap_runs, options.seed,
                      [&](double done) { Say(options, "refits with strokes at random", done); });
  const Eigen::MatrixXd about = draws.colwise() - draws.rowwise().mean();
  fit.covariance = about * about.transpose() / static_cast<double>(draws.cols() - 1);
  std::size_t index = 0;
  for (Cause& cause : out.causes) {
    if (CauseNamed(cause.kind).in_scatter_only) continue;  // not in the fit
    DescribeEffect(problem, fit, accepted.places[index++], draws, cause);
    WidenIntervals(problem, fit.point, cause);
  }
  out.bootstrap_runs = options.bootstrap_runs;
}

/// What was accepted first was fitted before the rest was known, and only well enough to be judged.
Fit Together(const Problem& problem, Fit accepted) {
  Fit fit = FitOn(problem, std::move(accepted), FitEffort{});
  FitFromStated(problem, fit, FitEffort{});
  return fit;
}

/// Sizes of all that was accepted. The residual's own scatter from block to block widens the intervals
/// where it is more than white noise's.
void Describe(const Problem& problem, const Accepted& accepted, const Fit& fit, Diagnosis& out) {
  std::size_t index = 0;
  for (Cause& cause : out.causes) {
    if (CauseNamed(cause.kind).in_scatter_only) continue;  // not in the fit
    Fit scattered = fit;
    scattered.covariance *= accepted.scatter[index];
    DescribeEffect(problem, scattered, accepted.places[index++], cause);
    WidenIntervals(problem, fit.point, cause);
  }
}

/// The model's own numbers, as they are stated and as the log has them.
void DescribeBase(const Problem& problem, const Fit& fit, Diagnosis& out) {
  for (std::size_t i = 0; i < problem.terms.size(); ++i) {
    const BaseTerm& t = problem.terms[i];
    if (t.nuisance) continue;
    const double x = fit.point.base[i];
    const double sd =
        std::sqrt(std::max(0.0, fit.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i))));
    const double fitted = t.additive ? t.stated + x : t.stated * std::exp(x);
    out.base.push_back({t.name, t.stated, fitted, t.additive ? sd : fitted * sd});
  }
}

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
  const auto end = [&](const AxisModel& m) {
    double sum = 0.0;
    const auto rows = std::min(problem.rows(), static_cast<std::size_t>(1.0 / problem.log.period_s));
    for (std::size_t k = problem.rows() - rows; k < problem.rows() && m.level; ++k) sum += (*m.level)[k];
    return 1.0 + sum / static_cast<double>(rows);
  };
  const double factor = end(with) / end(without);
  StatedFriction& f = axis.friction;
  for (double* level : {&f.Fc_plus, &f.Fc_minus, &f.Fs_plus, &f.Fs_minus}) *level *= factor;
  (axis.two_inertia ? axis.load_inertia : axis.motor_inertia) += with.payload;
  if (factor == 1.0 && with.payload == 0.0) return;
  notes.emplace_back(
      "What changed while the log was recorded stands in the extended model as it was in the log's last "
      "second.");
}

/// What goes into a file: the model with all that has a name, and how good it is.
void DescribeModel(const Problem& problem, const Fit& nominal, const Fit& all, Diagnosis& out) {
  const Fit fit = KnownAlone(problem, all);
  const std::array<Point, 2> halves = FitHalves(problem, fit);
  out.fitted = FittedAxis(problem, fit, halves);
  TakeEndOfDrift(problem, fit, *out.fitted, out.notes);
  DescribeModelErrors(problem, nominal, fit, halves, out);
}

}  // namespace

Fit Quantify(const Problem& problem, const Fit& nominal, Accepted& accepted, const DiagnoseOptions& options,
             Diagnosis& out) {
  Fit fit = std::move(accepted.fit);
  if (!fit.point.effects.empty()) {
    fit = Together(problem, std::move(fit));
    if (options.bootstrap_runs > 0)
      Bootstrap(problem, accepted, fit, options, out);
    else
      Describe(problem, accepted, fit, out);
  }
  out.data_quality = problem.quality;
  DescribeBase(problem, fit, out);
  Say(options, "errors of the models", 1.0);
  DescribeModel(problem, nominal, fit, out);
  out.traces = MakeTraces(problem, nominal.point, fit.point);
  return fit;
}

}  // namespace contour::diagnosis
