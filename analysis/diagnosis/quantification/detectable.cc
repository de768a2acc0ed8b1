#include "analysis/diagnosis/quantification/detectable.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/parameters.h"
#include "analysis/diagnosis/screening/full_size.h"
#include "analysis/diagnosis/tuning/quantification_tuning.h"
#include "analysis/diagnosis/tuning/statistics.h"
#include "analysis/prediction_error/products.h"
#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {
namespace {

/// Standard errors that exceed a threshold of the squared score in 90 % of cases.
double Needed(double threshold) { return std::sqrt(std::max(threshold, 1.0)) + kNormal90; }

double Needed(const Problem& problem, const ScoreThreshold& threshold, const Scored& s) {
  return Needed(Threshold(problem, threshold, *s.effect, ScoreScaleOf(problem, s)) + Penalty(*s.effect));
}

/// An effect that is there makes every score scatter.
double ByChance(const Scored& s) { return std::min(s.overdispersion, kScreening.most_overdispersion); }

/// By the first amplitude: the linear estimate of what exceeds the threshold in 90 % of cases.
double LinearSize(const Problem& problem, const ScoreThreshold& threshold, const Scored& s) {
  const std::string& kind = s.effect->kind;
  if (InBase(problem, kind)) {
    // What is stated is as far off as its uncertainty says, and an effect may have to begin on the other
    // side.
    double variance = s.covariance(0, 0);
    const std::vector<std::size_t> terms = FreedTerms(problem, kind);
    if (!terms.empty()) variance += std::pow(problem.terms[terms[0]].sigma, 2);
    return Needed(problem, threshold, s) * std::sqrt(variance);
  }
  // The mean standard error over the amplitudes; a shape may lie along any of them.
  const double n = static_cast<double>(s.covariance.rows());
  return Needed(problem, threshold, s) * std::sqrt(std::max(0.0, s.covariance.trace() / n) * ByChance(s));
}

/// An effect and the first amplitude that is found in 90 % of cases.
struct Detectable {
  SharedEffect effect;
  double threshold = 0.0;  ///< exceeds the threshold
  double size = 0.0;       ///< passes everything
};

/// Of a shape that is not known (an exponent, an instant, a ratio) the one in the middle; of several lengths
/// of one shape the best, as the score test has it.
std::optional<Detectable> Middle(const Problem& problem, const ScoreThreshold& threshold,
                                 std::span<const Scored> scored, const std::string& kind) {
  std::vector<std::pair<double, const Scored*>> shapes;
  // What is far from linear is no measure of a kind of which a small size shows, too.
  const bool small_shows = std::any_of(scored.begin(), scored.end(), [&](const Scored& s) {
    return s.effect->kind == kind && s.effect->start.empty();
  });
  for (const Scored& s : scored) {
    if (s.effect->kind != kind || (small_shows && !s.effect->start.empty())) continue;
    const auto longer = [&](const Scored& other) { return other.effect->shorter == s.effect; };
    if (std::any_of(scored.begin(), scored.end(), longer)) continue;
    double least = LinearSize(problem, threshold, s);
    const Scored* best = &s;
    for (const Scored& other : scored) {
      const double size = LinearSize(problem, threshold, other);
      if (other.effect != s.effect->shorter || size >= least) continue;
      least = size;
      best = &other;
    }
    if (std::isfinite(least)) shapes.emplace_back(least, best);
  }
  if (shapes.empty()) return std::nullopt;
  std::sort(shapes.begin(), shapes.end());
  const auto& [size, at] = shapes[(shapes.size() - 1) / 2];
  return Detectable{at->effect, size,
                    (InBase(problem, kind) ? 1.0 : kQuantification.beyond_threshold) * size};
}

/// A point in addition to the base, with a first amplitude.
Point WithEffect(const Fit& base, const SharedEffect& effect, double first) {
  Point p = base.point;
  p.effects.push_back(effect);
  p.amplitudes.push_back(effect->start.empty() ? std::vector<double>(effect->steps.size(), 0.0)
                                               : effect->start);
  p.amplitudes.back()[0] = first;
  return p;
}

/// Products of what is left of runs with an effect once the base has followed to first order; on the diagonal
/// the drop that finding the effect promises.
Eigen::MatrixXd LeftOf(const Problem& problem, const Fit& base, std::span<const Point> points) {
  std::vector<std::vector<double>> runs = problem.Residuals(points);
  std::vector<const double*> columns;
  Eigen::MatrixXd onto(base.jacobian.cols(), static_cast<Eigen::Index>(runs.size()));
  for (std::vector<double>& r : runs) {
    for (std::size_t k = 0; k < r.size(); ++k) r[k] -= base.residual[k];
    onto.col(static_cast<Eigen::Index>(columns.size())) = GradientOf(base.jacobian, r);
    columns.push_back(r.data());
  }
  return ProductsOf(columns, columns, problem.data_size()) - onto.transpose() * base.covariance * onto;
}

/// What begins far from linear shows by runs at several sizes how it grows. Its fit begins where the linear
/// test promises something, which knows the columns at the grid's places only.
std::optional<Detectable> ByRuns(const Problem& problem, const Fit& base, const ScoreThreshold& threshold,
                                 std::span<const Scored> scored, const Detectable& linear) {
  std::vector<double> sizes;
  std::vector<Point> points;
  const double largest = linear.effect->high[0];
  for (double size = 0.5 * linear.threshold; size < largest && points.size() < kLanes; size *= 2.0) {
    sizes.push_back(size);
    points.push_back(WithEffect(base, linear.effect, size));
  }
  double enough = 0.0;
  std::vector<double> promising;
  for (const Scored& s : scored) {
    if (s.effect == linear.effect) enough = std::pow(Needed(problem, threshold, s), 2) * ByChance(s);
    if (s.effect->kind != linear.effect->kind || promising.size() >= kLanes) continue;
    points.push_back(WithEffect(base, s.effect, s.effect->steps[0]));
    promising.push_back(std::pow(Needed(problem, threshold, s) - kNormal90, 2));
  }
  const Eigen::MatrixXd left = LeftOf(problem, base, points);
  const auto n = static_cast<Eigen::Index>(sizes.size());
  // The drop over what is asked for, at its worst.
  std::vector<double> over;
  for (Eigen::Index i = 0; i < n; ++i) {
    double promise = 0.0;
    for (std::size_t g = 0; g < promising.size(); ++g) {
      const Eigen::Index at = n + static_cast<Eigen::Index>(g);
      promise = std::max(promise, std::pow(left(i, at), 2) / left(at, at) / promising[g]);
    }
    over.push_back(std::min(left(i, i) / enough, promise));
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (!(over[i] > 1.0)) continue;
    double size = sizes[i];
    if (i > 0 && over[i - 1] > 0.0) size *= std::exp2(-std::log(over[i]) / std::log(over[i] / over[i - 1]));
    return Detectable{linear.effect, size, kQuantification.beyond_threshold * size};
  }
  return std::nullopt;
}

/// The stiffest coupling that shows at its usual share of the inertia and is a fault: its place in the grid.
std::optional<Detectable> Stiffest(const Problem& problem, const Fit& base, const ScoreThreshold& threshold,
                                   std::span<const Scored> scored) {
  std::vector<Point> points;
  std::vector<const Scored*> places;
  for (const Scored& s : scored) {
    if (!CauseNamed(s.effect->kind).coupling || s.effect->start.empty() ||
        s.effect->order > NoFault_Hz(problem))
      continue;
    places.push_back(&s);
    points.push_back(WithEffect(base, s.effect, s.effect->start[0]));
  }
  if (points.empty()) return std::nullopt;
  const Eigen::VectorXd promised = LeftOf(problem, base, points).diagonal();
  const Scored* best = nullptr;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double enough =
        std::pow(kQuantification.beyond_threshold * Needed(problem, threshold, *places[i]), 2) *
        ByChance(*places[i]);
    if (promised(static_cast<Eigen::Index>(i)) > enough &&
        (best == nullptr || places[i]->effect->order > best->effect->order))
      best = places[i];
  }
  if (best == nullptr) return std::nullopt;
  const double share = best->effect->start[0];
  return Detectable{best->effect, share, share};
}

std::optional<Detectable> Smallest(const Problem& problem, const Fit& base, const ScoreThreshold& threshold,
                                   std::span<const Scored> scored, const std::string& kind) {
  std::optional<Detectable> d = Middle(problem, threshold, scored, kind);
  if (!d || InBase(problem, kind) || d->effect->start.empty()) return d;
  if (CauseNamed(kind).coupling) return Stiffest(problem, base, threshold, scored);
  return ByRuns(problem, base, threshold, scored, *d);
}

}  // namespace

std::map<std::string, std::map<std::string, double>> SmallestDetectable(const Problem& problem,
                                                                        const Fit& base,
                                                                        const Screened& screened,
                                                                        std::span<const std::string> only) {
  std::map<std::string, std::map<std::string, double>> out;
  for (const CauseDefinition* cause : AllCauses()) {
    if (cause->in_scatter_only) continue;
    const std::string kind(*cause->name);
    if (!only.empty() && std::find(only.begin(), only.end(), kind) == only.end()) continue;
    const std::optional<Detectable> d = Smallest(problem, base, screened.threshold, screened.scored, kind);
    if (!d || d->threshold > kQuantification.beyond_threshold * (*cause->largest)(problem)) continue;
    Fit at;
    at.point = base.point;
    // Numbers of the model deviate from what is stated.
    if (InBase(problem, kind)) std::fill(at.point.base.begin(), at.point.base.end(), 0.0);
    // A fault makes the coupling softer.
    const bool stiffness = cause->coupling && InBase(problem, kind);
    at.point = WithEffect(at, d->effect, stiffness ? -d->size : d->size);
    const auto count = static_cast<Eigen::Index>(ParameterCount(at.point));
    at.covariance = Eigen::MatrixXd::Zero(count, count);
    Cause described;
    described.kind = kind;
    DescribeEffect(problem, at, at.point.effects.size() - 1, described);
    const std::string name(*cause->main_parameter);
    // Of a kind that has several forms, the one that is looked for may have another size.
    if (const auto size = described.parameters.find(name); size != described.parameters.end())
      out[kind][name] = std::fabs(size->second.value);
  }
  if (screened.jitter.tested) {
    const CauseDefinition& cause = CauseInScatter();
    out[std::string(*cause.name)][std::string(*cause.main_parameter)] =
        1e6 * std::sqrt(kQuantification.beyond_threshold *
                        Needed(Threshold(problem, screened.threshold) + kScreening.penalty_per_amplitude) *
                        screened.jitter.sigma_s2);
  }
  return out;
}

std::vector<std::string> NotExcited(const std::map<std::string, std::map<std::string, double>>& detectable) {
  std::vector<std::string> out;
  for (const CauseDefinition* cause : AllCauses())
    if (!detectable.contains(std::string(*cause->name))) out.emplace_back(*cause->name);
  return out;
}

}  // namespace contour::diagnosis
