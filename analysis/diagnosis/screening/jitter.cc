#include "analysis/diagnosis/screening/jitter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"
#include "analysis/diagnosis/tuning/statistics.h"

namespace contour::diagnosis {
namespace {

constexpr int kParts = kJitter.parts;
constexpr std::size_t kBlock = kJitter.block_rows;
constexpr int kSpeed = kParts;

using Row = Eigen::Matrix<double, kParts + 2, 1>;
using Square = Eigen::Matrix<double, kParts + 2, kParts + 2>;

/// The variance of the noise, block by block, and what it may go with. The noise may have another level in
/// each part of the log: a share of the variance per part, of the squared speed, of the squared acceleration.
struct Variances {
  std::vector<Row> rows;
  std::vector<double> variance;
};

Variances BlockVariances(const Problem& problem, const Fit& fit) {
  const Signals& s = *problem.signals;
  // Slower than this, quantisation is no noise of constant variance; faster, it does not grow with the speed.
  const double slowest = kJitter.slowest_counts_per_row * problem.stated.position_step / problem.log.period_s;
  Variances out;
  for (std::size_t from = 2; from + kBlock <= problem.rows(); from += kBlock) {
    double sum = 0.0, w2 = 0.0, a2 = 0.0;
    bool use = true;
    for (std::size_t k = from; k < from + kBlock && use; ++k) {
      use = problem.counted[k] != 0 && problem.counted[k - 2] != 0 && problem.root_weight[k] > 0.0 &&
            problem.root_weight[k - 1] > 0.0 && problem.root_weight[k - 2] > 0.0 &&
            std::fabs(s.velocity[k]) > slowest;
      if (!use) break;
      const auto at = [&](std::size_t i) { return fit.residual[i] / problem.root_weight[i]; };
      const double d = at(k) - 2.0 * at(k - 1) + at(k - 2);
      sum += d * d / kVarianceOfSecondDifference;
      w2 += s.velocity[k] * s.velocity[k];
      a2 += s.acceleration[k] * s.acceleration[k];
    }
    if (!use) continue;
    const double n = kBlock;
    Row row = Row::Zero();
    row(static_cast<Eigen::Index>(from * kParts / problem.rows())) = 1.0;
    row(kSpeed) = w2 / n;
    row(kSpeed + 1) = a2 / n;
    out.rows.push_back(row);
    out.variance.push_back(sum / n);
  }
  return out;
}

struct WeightedFit {
  Row c;
  Square covariance;
};

/// Least squares with weights that follow the variance; the covariance as the blocks scatter.
WeightedFit FitVariances(const std::vector<Row>& rows, const std::vector<double>& variance) {
  Row c = Row::Zero();
  c.head<kParts>().setOnes();
  Square inverse = Square::Identity(), scatter = Square::Zero();
  std::vector<double> sorted = variance;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double middle = sorted[sorted.size() / 2];
  for (int pass = 0; pass < kParts; ++pass) {
    Square normal = Square::Identity() * 1e-12;
    Row right = Row::Zero();
    scatter.setZero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double expected =
          std::max(pass == 0 ? middle : rows[i].dot(c), middle / kScreening.most_overdispersion);
      const double weight = 1.0 / (expected * expected);
      // A block with a shock in it counts as far as it may be chance.
      const double seen = std::min(variance[i], kScreening.most_overdispersion * expected);
      normal += weight * rows[i] * rows[i].transpose();
      right += weight * seen * rows[i];
      scatter += std::pow(weight * (seen - rows[i].dot(c)), 2) * rows[i] * rows[i].transpose();
    }
    inverse = normal.inverse();
    c = inverse * right;
  }
  return {c, inverse * scatter * inverse};
}

/// Variance of the second differences of the residual that a white error of the reading makes.
double GainOfReading(const Problem& problem) {
  const std::vector<double> h = PulseResponse(problem, true);
  double gain = 0.0;
  for (std::size_t k = 0; k < h.size(); ++k) {
    const double d = h[k] - 2.0 * (k > 0 ? h[k - 1] : 0.0) + (k > 1 ? h[k - 2] : 0.0);
    gain += d * d / kVarianceOfSecondDifference;
  }
  return gain;
}

}  // namespace

Jitter TestJitter(const Problem& problem, const Fit& fit) {
  auto [rows, variance] = BlockVariances(problem, fit);
  Jitter out;
  if (rows.size() < static_cast<std::size_t>(kScreening.blocks)) return out;
  Row top = Row::Constant(1e-300);
  for (const auto& r : rows) top = top.cwiseMax(r);
  double low = 1.0;
  for (auto& r : rows) {
    r = r.cwiseQuotient(top).eval();
    low = std::min(low, r(kSpeed));
  }
  if (low > 0.5 * 0.5) return out;
  out.tested = true;
  const auto [c, covariance] = FitVariances(rows, variance);
  const double sigma = std::sqrt(std::max(covariance(kSpeed, kSpeed), 1e-300));
  out.drop = c(kSpeed) > 0.0 ? std::pow(c(kSpeed) / sigma, 2) : 0.0;
  const double per = GainOfReading(problem) * top(kSpeed);
  out.sigma_s2 = sigma / per;
  out.rms_s = std::sqrt(std::max(c(kSpeed), 0.0) / per);
  out.sigma_s = 0.5 * sigma / per / std::max(out.rms_s, std::sqrt(sigma / per));
  return out;
}

}  // namespace contour::diagnosis
