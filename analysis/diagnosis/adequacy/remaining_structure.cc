#include "analysis/diagnosis/adequacy/remaining_structure.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/diagnosis/adequacy/structure_maps.h"
#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/screening/gross_sliding.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/statistics.h"

namespace contour::diagnosis {
namespace {

// Beyond so many deviations erfc is nothing, and its asymptotic form exact.
constexpr double kAsymptotic = 30.0;

double SizeAt(const BinnedRows& rows, std::size_t k) { return rows.size.empty() ? 1.0 : rows.size[k]; }

/// Takes out of the gradient what is constant in each bin; the squared weights of every bin.
std::vector<double> TakeOut(const BinnedRows& known, const std::vector<double>& weight,
                            std::vector<double>& gradient) {
  const auto count = static_cast<std::size_t>(known.count);
  std::vector<double> g(count, 0.0), all(count, 1e-300);
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    if (known.bin[k] < 0) continue;
    const auto i = static_cast<std::size_t>(known.bin[k]);
    const double size = SizeAt(known, k);
    g[i] += size * gradient[k];
    all[i] += std::pow(size * weight[k], 2);
  }
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    if (known.bin[k] < 0) continue;
    const auto i = static_cast<std::size_t>(known.bin[k]);
    gradient[k] -= SizeAt(known, k) * weight[k] * weight[k] * g[i] / all[i];
  }
  return all;
}

/// How probable a normal number is above z, as -2 ln.
double NormalScore(double z) {
  if (z < kAsymptotic) return -2.0 * std::log(0.5 * std::erfc(z / std::numbers::sqrt2));
  return z * z + 2.0 * std::log(z * std::sqrt(2.0 * std::numbers::pi));
}

/// How probable chi^2 of so many degrees is above x, as -2 ln (Wilson and Hilferty, PNAS 17, 1931).
double ChiSquareScore(double x, double degrees) {
  const double variance = 2.0 / (9.0 * degrees);
  return NormalScore((std::cbrt(std::max(0.0, x) / degrees) - 1.0 + variance) / std::sqrt(variance));
}

/// The score that something unknown must exceed: it shares the asked rate with every kind of cause, and its
/// classes share theirs.
double Threshold(double false_alarm_rate) {
  const auto kinds = static_cast<double>(AllCauses().size() + 1);
  return -2.0 * std::log(false_alarm_rate / (kinds * static_cast<double>(kStructureClasses.size())));
}

std::vector<double> Autocorrelation(const std::vector<double>& response) {
  std::vector<double> out(response.size(), 0.0);
  for (std::size_t lag = 0; lag < out.size(); ++lag)
    for (std::size_t i = 0; i + lag < response.size(); ++i) out[lag] += response[i] * response[i + lag];
  return out;
}

/// What the gradient has of every bin, block of time by block of time, and how much of it is known of one
/// bin.
struct BinSums {
  Eigen::MatrixXd gradient;  ///< bins x blocks
  std::vector<double> information, free;
  std::vector<int> blocks;  ///< that a bin is seen in
};

BinSums SumsOf(const BinnedRows& rows, const BinnedRows& known, const std::vector<double>& gradient,
               const std::vector<double>& all, const std::vector<double>& correlation,
               const std::vector<double>& weight) {
  const auto count = static_cast<std::size_t>(rows.count), others = static_cast<std::size_t>(known.count);
  const std::size_t n = rows.bin.size();
  BinSums out;
  out.gradient = Eigen::MatrixXd::Zero(rows.count, kBlocks);
  out.information.assign(count, 0.0);
  out.free.assign(count, 1.0);
  out.blocks.assign(count, 0);
  std::vector<double> own(count, 1e-300), shared(count * others, 0.0);
  std::vector<Eigen::Index> last(count, -1);
  for (std::size_t k = 0; k < n; ++k) {
    if (rows.bin[k] < 0) continue;
    const auto b = static_cast<std::size_t>(rows.bin[k]);
    const auto block = static_cast<Eigen::Index>(k) * kBlocks / static_cast<Eigen::Index>(n);
    const double size = SizeAt(rows, k) * weight[k];
    out.gradient(rows.bin[k], block) += SizeAt(rows, k) * gradient[k];
    if (last[b] != block) ++out.blocks[b];
    last[b] = block;
    double sum = 0.5 * correlation[0] * size;
    for (std::size_t lag = 1; lag < correlation.size() && k >= lag; ++lag)
      if (rows.bin[k - lag] == rows.bin[k]) sum += correlation[lag] * weight[k - lag] * SizeAt(rows, k - lag);
    out.information[b] += 2.0 * sum * size;
    own[b] += size * size;
    if (known.bin[k] >= 0)
      shared[b * others + static_cast<std::size_t>(known.bin[k])] += size * weight[k] * SizeAt(known, k);
  }
  // What was taken out does not scatter any more.
  for (std::size_t b = 0; b < count; ++b)
    for (std::size_t i = 0; i < others; ++i)
      out.free[b] -= std::pow(shared[b * others + i], 2) / (own[b] * all[i]);
  return out;
}

/// How probable the drop is when blocks of time have random signs, as -2 ln: mean and variance of that drop
/// are known, and the curve of a chi^2 that has them stands for it. What is seen in one block only has the
/// same drop with either sign, and says nothing.
double ScoreOfBlocks(const Eigen::MatrixXd& scaled, double drop) {
  const Eigen::MatrixXd products = scaled.transpose() * scaled;
  const double mean = products.trace();
  const double variance = 2.0 * (products.squaredNorm() - products.diagonal().squaredNorm());
  if (!(mean > 0.0) || !(variance > 0.0)) return 0.0;
  const double degrees = 2.0 * mean * mean / variance;
  return ChiSquareScore(drop * degrees / mean, degrees);
}

/// Bins of time are seen once each. Noise that is not white makes all of them larger: their median says by
/// how much. Whether their mean is larger than that goes with, by its own standard error: so single shocks,
/// of which every log has some, say little, and neighbours that go together count for fewer.
double ScoreOfTimes(const std::vector<double>& deviations) {
  const auto n = static_cast<double>(deviations.size());
  std::vector<double> squares;
  double mean = 0.0, variance = 0.0;
  for (const double z : deviations) {
    squares.push_back(z * z);
    mean += z * z / n;
  }
  for (const double x : squares) variance += (x - mean) * (x - mean) / n;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  double together = 1.0;
  for (std::size_t lag = 1; lag * lag < deviations.size(); ++lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < deviations.size(); ++i) product += deviations[i] * deviations[i - lag];
    together += 2.0 * std::pow(product / (n * mean), 2);
  }
  const double by_noise = std::max(1.0, *middle * kNormalMad * kNormalMad);
  return NormalScore((mean - by_noise) / std::sqrt(variance * together / n + 1e-300));
}

}  // namespace

RemainingStructure TestBins(const BinnedRows& rows, const BinnedRows& known, std::vector<double> gradient,
                            const std::vector<double>& response, const std::vector<double>& weight) {
  const std::vector<double> all = TakeOut(known, weight, gradient);
  const BinSums sums = SumsOf(rows, known, gradient, all, Autocorrelation(response), weight);
  RemainingStructure out;
  out.over = rows.over;
  out.quantity = rows.quantity;
  out.series = rows.series;
  out.structure_class = rows.structure_class;
  Eigen::MatrixXd scaled = sums.gradient;
  std::vector<double> deviations;
  double most = 0.0;
  for (int b = 0; b < rows.count; ++b) {
    const auto i = static_cast<std::size_t>(b);
    // Little more than what was taken out.
    const bool says =
        sums.blocks[i] > 0 && sums.information[i] > 0.0 && sums.free[i] > kScreening.negligible_share;
    scaled.row(b) *= says ? 1.0 / std::sqrt(sums.information[i]) : 0.0;
    if (!says) continue;
    const double g = sums.gradient.row(b).sum(), drop = g * g / sums.information[i];
    deviations.push_back(g / std::sqrt(sums.information[i] * sums.free[i]));
    out.drop += drop;
    out.bins += sums.free[i];
    if (drop <= most) continue;
    most = drop;
    out.amount = -g / sums.information[i];
    out.at = rows.place ? rows.place(b) : "";
  }
  if (!(out.bins > 0.0)) return out;
  // No more than white noise would make of it, and no more than the noise of this log.
  const bool once = rows.quantity == Quantity::kTime;
  out.score = std::min(ChiSquareScore(out.drop, out.bins),
                       once ? ScoreOfTimes(deviations) : ScoreOfBlocks(scaled, out.drop));
  return out;
}

std::vector<RemainingStructure> FindStructure(const Problem& problem, const Fit& fit,
                                              double false_alarm_rate) {
  const auto n = static_cast<std::ptrdiff_t>(problem.rows());
  const std::vector<double> innovation(fit.residual.begin(), fit.residual.begin() + n);
  const std::vector<double> weight(problem.root_weight.begin(), problem.root_weight.begin() + n);
  const NoiseFilter::Gradient back = problem.noise.Back(innovation, problem.counted, weight.data());
  const std::vector<double> response = PulseResponse(problem, false);
  const bool mismatch = FrictionModelMismatch(problem, fit);
  const std::vector<bool> slides = mismatch ? GrossSliding(problem) : Slides(problem);
  const BinnedRows known = FrictionCurve(problem, slides);
  const std::vector<BinnedRows> maps = StructureMaps(problem, slides);
  std::vector<RemainingStructure> out;
  for (const BinnedRows& rows : maps) {
    // Motions take turns over the time, and a law of friction that does not hold is wrong in some of them.
    if (mismatch && rows.structure_class == kUnexplainedFriction) continue;
    out.push_back(TestBins(rows, known, back.motor, response, weight));
    // The best of so many.
    out.back().score = std::max(0.0, out.back().score - 2.0 * std::log(static_cast<double>(maps.size())));
    out.back().asked = Threshold(false_alarm_rate);
  }
  std::stable_sort(out.begin(), out.end(), [](const RemainingStructure& a, const RemainingStructure& b) {
    return a.score - a.asked > b.score - b.asked;
  });
  return out;
}

}  // namespace contour::diagnosis
