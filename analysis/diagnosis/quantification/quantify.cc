#include "analysis/diagnosis/quantification/quantify.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/parameters.h"
#include "analysis/diagnosis/decision/residual_trace.h"
#include "analysis/diagnosis/quantification/follow_play.h"
#include "analysis/diagnosis/quantification/no_size.h"
#include "analysis/diagnosis/quantification/widen.h"
#include "analysis/diagnosis/quantification/withdraw.h"
#include "analysis/diagnosis/tuning/fit_effort.h"
#include "analysis/prediction_error/bootstrap.h"
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
  }
}

bool IsPlay(const Problem& problem, Point point, std::size_t place) {
  const double gap = problem.Build(point).gap;
  std::fill(point.amplitudes[place].begin(), point.amplitudes[place].end(), 0.0);
  return gap > problem.Build(point).gap;
}

/// By what the fit's scatter does not know: of plays, or of all others.
void Widen(const Problem& problem, const Accepted& accepted, const Fit& fit, bool plays, Diagnosis& out) {
  std::size_t index = 0;
  for (Cause& cause : out.causes) {
    if (CauseNamed(cause.kind).in_scatter_only) continue;  // not in the fit
    const std::size_t place = accepted.places[index++];
    if (IsPlay(problem, fit.point, place) != plays) continue;
    WidenByObserver(problem, accepted, place, cause);
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

}  // namespace

Fit Quantify(const Problem& problem, const Fit& nominal, Accepted& accepted, const DiagnoseOptions& options,
             Diagnosis& out) {
  Fit fit = std::move(accepted.fit);
  if (!fit.point.effects.empty()) {
    fit = Together(problem, std::move(fit));
    do {
      if (options.bootstrap_runs > 0)
        Bootstrap(problem, accepted, fit, options, out);
      else
        Describe(problem, accepted, fit, out);
      Widen(problem, accepted, fit, false, out);
    } while (WithdrawIdle(problem, fit, accepted, out));
    // How large a play is hangs on the observer; whether there is one does not.
    Widen(problem, accepted, fit, true, out);
    MarkNoSize(problem, fit, accepted, out);
    if (accepted.play_is_bound && problem.Build(fit.point).gap > 0.0)
      out.notes.emplace_back(
          "The play is at least as wide as stated: it shows in what noise leaves of a slow observer, which "
          "makes a play narrower than it is.");
  }
  out.data_quality = problem.quality;
  DescribeBase(problem, fit, out);
  out.traces = MakeTraces(problem, nominal, fit);
  return fit;
}

}  // namespace contour::diagnosis
