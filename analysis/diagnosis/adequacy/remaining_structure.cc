#include "analysis/diagnosis/adequacy/remaining_structure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/diagnosis/adequacy/structure_maps.h"
#include "analysis/diagnosis/screening/gross_sliding.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/adequacy_tuning.h"
#include "analysis/diagnosis/tuning/model_error.h"

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

/// How probable chi^2 of so many degrees is above x, as -2 ln (Wilson and Hilferty, PNAS 17, 1931).
double ChiSquareScore(double x, double degrees) {
  const double variance = 2.0 / (9.0 * degrees);
  const double z = (std::cbrt(std::max(0.0, x) / degrees) - 1.0 + variance) / std::sqrt(variance);
  if (z < kAsymptotic) return -2.0 * std::log(0.5 * std::erfc(z / std::numbers::sqrt2));
  return z * z + 2.0 * std::log(z * std::sqrt(2.0 * std::numbers::pi));
}

/// The score that something unknown must exceed.
double Threshold(const Problem& problem, std::string_view structure_class, double false_alarm_rate) {
  const double own =
      kAdequacy.share_of_false_alarms / static_cast<double>(kStructureClasses.size()) * false_alarm_rate;
  const double errors = AllowancePerRow(structure_class, own) * static_cast<double>(problem.rows());
  return std::max(-2.0 * std::log(own), -2.0 * std::log(kCalibratedRate) + errors);
}

std::vector<double> Autocorrelation(const std::vector<double>& response) {
  std::vector<double> out(std::min(kAdequacy.response_rows, response.size()), 0.0);
  for (std::size_t lag = 0; lag < out.size(); ++lag)
    for (std::size_t i = 0; i + lag < response.size(); ++i) out[lag] += response[i] * response[i + lag];
  return out;
}

}  // namespace

RemainingStructure TestBins(const BinnedRows& rows, const BinnedRows& known, std::vector<double> gradient,
                            const std::vector<double>& response, const std::vector<double>& weight) {
  const std::vector<double> all = TakeOut(known, weight, gradient), correlation = Autocorrelation(response);
  const auto count = static_cast<std::size_t>(rows.count), others = static_cast<std::size_t>(known.count);
  std::vector<double> g(count, 0.0), information(count, 0.0), seen(count, 0.0), own(count, 1e-300);
  std::vector<double> shared(count * others, 0.0);
  for (std::size_t k = 0; k < rows.bin.size(); ++k) {
    if (rows.bin[k] < 0) continue;
    const auto b = static_cast<std::size_t>(rows.bin[k]);
    const double size = SizeAt(rows, k) * weight[k];
    g[b] += SizeAt(rows, k) * gradient[k];
    seen[b] += 1.0;
    double sum = 0.5 * correlation[0] * size;
    for (std::size_t lag = 1; lag < correlation.size() && k >= lag; ++lag)
      if (rows.bin[k - lag] == rows.bin[k]) sum += correlation[lag] * weight[k - lag] * SizeAt(rows, k - lag);
    information[b] += 2.0 * sum * size;
    own[b] += size * size;
    if (known.bin[k] >= 0)
      shared[b * others + static_cast<std::size_t>(known.bin[k])] += size * weight[k] * SizeAt(known, k);
  }
  RemainingStructure out;
  out.over = rows.over;
  out.quantity = rows.quantity;
  out.series = rows.series;
  out.structure_class = rows.structure_class;
  double most = 0.0;
  for (std::size_t b = 0; b < count; ++b) {
    if (seen[b] < kAdequacy.fewest_rows_per_bin || !(information[b] > 0.0)) continue;
    // What was taken out does not scatter any more.
    double free = 1.0;
    for (std::size_t i = 0; i < others; ++i) free -= std::pow(shared[b * others + i], 2) / (own[b] * all[i]);
    if (free < kAdequacy.least_free_share) continue;
    const double drop = g[b] * g[b] / information[b];
    out.drop += drop;
    out.bins += free;
    if (drop <= most) continue;
    most = drop;
    out.amount = -g[b] / information[b];
    out.at = rows.place ? rows.place(static_cast<int>(b)) : "";
  }
  if (out.bins > 0.0) out.score = ChiSquareScore(out.drop, out.bins);
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
    out.back().asked = Threshold(problem, rows.structure_class, false_alarm_rate);
  }
  std::stable_sort(out.begin(), out.end(), [](const RemainingStructure& a, const RemainingStructure& b) {
    return a.score - a.asked > b.score - b.asked;
  });
  return out;
}

}  // namespace contour::diagnosis
