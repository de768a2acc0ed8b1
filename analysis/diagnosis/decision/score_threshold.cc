#include "analysis/diagnosis/decision/score_threshold.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/chi_square.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/diagnosis/tuning/model_error.h"

namespace contour::diagnosis {
namespace {

// Waves of a grid come from a scan, one or several of it.
bool FromScan(const Scored& s) { return s.effect->wave && s.effect->grid > 1.0; }

/// The scans that the candidates come from: kinds, and grids of one kind.
std::size_t ScansOf(std::span<const Scored> scored) {
  std::set<std::pair<std::string, double>> scans;
  for (const Scored& s : scored)
    if (FromScan(s)) scans.insert({s.effect->kind, s.effect->grid});
  return scans.size();
}

/// What the largest of the draws exceeds with a probability. Far out, Gumbel's distribution with their mean
/// and deviation stands for them.
double Exceeded(const std::vector<double>& sorted, double probability) {
  const auto count = static_cast<double>(sorted.size());
  const auto drawn = [&](double p) {
    return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(p * count))];
  };
  const double often = 1.0 / std::sqrt(count);
  if (probability >= often) return drawn(1.0 - probability);
  double mean = 0.0, square = 0.0;
  for (const double x : sorted) mean += x / count;
  for (const double x : sorted) square += (x - mean) * (x - mean) / count;
  const auto gumbel = [&](double p) {
    return mean +
           std::sqrt(6.0 * square) / std::numbers::pi * (-std::log(-std::log1p(-p)) - std::numbers::egamma);
  };
  return drawn(1.0 - often) + std::max(0.0, gumbel(probability) - gumbel(often));
}

}  // namespace

ScoreThreshold SignFlips(std::span<const Scored> scored, double false_alarm_rate, std::uint64_t seed,
                         double more) {
  std::mt19937_64 random(seed * 2654435761U + 99);
  std::uniform_real_distribution<double> uniform(1e-12, 1.0);
  const std::size_t scans = std::max<std::size_t>(1, ScansOf(scored));
  std::vector<double> largest;
  Eigen::VectorXd signs(kBlocks);
  for (int d = 0; d < kThreshold.flip_draws; ++d) {
    for (Eigen::Index b = 0; b < kBlocks; ++b) signs(b) = (random() & 1U) != 0 ? 1.0 : -1.0;
    double best = -1e300;
    for (std::size_t i = 0; i < scans; ++i)
      best = std::max(best, -2.0 * std::log(-std::log(uniform(random))) - ScanPenalty());
    for (const Scored& s : scored) {
      if (FromScan(s)) continue;
      const Eigen::VectorXd h = s.per_block * signs;
      best = std::max(best, h.dot(s.covariance * h) / s.within_blocks - Penalty(*s.effect));
    }
    largest.push_back(best);
  }
  std::sort(largest.begin(), largest.end());
  return {Exceeded(largest, false_alarm_rate) + more, Exceeded(largest, kRounds.false_alarm_rate) + more,
          false_alarm_rate};
}

ScoreThreshold ByChanceAlone(ScoreThreshold threshold) {
  threshold.model_error = false;
  threshold.leakage = 0.0;
  threshold.leakage_of_kind.clear();
  return threshold;
}

double ScoreThreshold::LeakageAs(const std::string& kind) const {
  const auto same = leakage_of_kind.find(kind);
  return leakage + (same == leakage_of_kind.end() ? 0.0 : same->second);
}

namespace {

/// `covariance`: of what the log says about the numbers that the kind frees.
double VarianceRatio(const Problem& problem, const std::string& kind, const Eigen::MatrixXd& covariance) {
  // All forces at once: what the log leaves of each of them counts.
  if (CauseNamed(kind).common_factor || !InBase(problem, kind)) return 1.0;
  const std::vector<std::size_t> terms = FreedTerms(problem, kind);
  double most = 0.0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (at < covariance.rows())
      most = std::max(most, covariance(at, at) * std::pow(problem.terms[terms[i]].sigma, -2));
  }
  return most;
}

double ByChanceAndErrors(const Problem& problem, const ScoreThreshold& threshold) {
  if (!threshold.model_error) return threshold.flips;
  const double errors = AllowancePerRow(threshold.rate) * static_cast<double>(problem.rows());
  return std::max(threshold.flips, threshold.calibrated + errors);
}

}  // namespace

ScoreScale ScoreScaleOf(const Problem& problem, const Scored& scored) {
  return {scored.overdispersion, VarianceRatio(problem, scored.effect->kind, scored.covariance)};
}

ScoreScale ScoreScaleOf(const Problem& problem, const Fit& fit) {
  ScoreScale score_scale;
  const std::string& kind = fit.point.effects.back()->kind;
  if (!InBase(problem, kind)) {
    score_scale.overdispersion = OverdispersionOfLast(problem, fit);
    return score_scale;
  }
  const auto n = static_cast<Eigen::Index>(fit.point.amplitudes.back().size());
  // The base's term goes on having its prior; what is free scatters by as much more.
  score_scale.variance_ratio =
      CauseNamed(kind).common_factor
          ? 1.0
          : std::max(0.0, VarianceRatio(problem, kind, fit.covariance.bottomRightCorner(n, n)) - 1.0);
  return score_scale;
}

double Threshold(const Problem& problem, const ScoreThreshold& threshold) {
  return ByChanceAndErrors(problem, threshold) + threshold.leakage;
}

double Threshold(const Problem& problem, const ScoreThreshold& threshold, const Effect& effect,
                 const ScoreScale& score_scale) {
  double left = threshold.LeakageAs(effect.kind);
  if (!InBase(problem, effect.kind))
    return ByChanceAndErrors(problem, threshold) + left / score_scale.overdispersion;
  // The stated uncertainties say what chance does here; every kind has its share of the asked rate.
  const std::size_t degrees = std::max<std::size_t>(1, FreedTerms(problem, effect.kind).size());
  const double by_chance = ChiSquareQuantile(
      degrees,
      std::max(threshold.rate / static_cast<double>(AllCauses().size()), kThreshold.beyond_stated_rate));
  if (threshold.accepted == 0) return by_chance - Penalty(effect);
  // At its worst residual leakage of chi^2 moves the number by its root, in standard errors of the log.
  const double moved = score_scale.variance_ratio * left;
  left = std::min(left, moved + 2.0 * std::sqrt(moved * by_chance));
  return std::max(by_chance - Penalty(effect), threshold.flips) + left;
}

}  // namespace contour::diagnosis
