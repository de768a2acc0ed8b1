#include "analysis/diagnosis/screening/jitter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"
#include "analysis/diagnosis/tuning/statistics.h"

namespace contour::diagnosis {
namespace {

constexpr int kParts = kJitter.parts;
constexpr std::size_t kBlock = kJitter.block_rows;
constexpr int kSpeed = kParts, kAcceleration = kSpeed + 1, kRounding = kAcceleration + 1,
              kColumns = kRounding + 1;
// On the diagonal of the normal equations: keeps the solver away from zero where a part has no rows.
constexpr double kNoRows = 1e-12;

using Row = Eigen::Matrix<double, kColumns, 1>;
using Square = Eigen::Matrix<double, kColumns, kColumns>;

/// The variance of the noise, block by block, and what it may go with. The noise may have another level in
/// each part of the log: a share of the variance per part, of the squared speed, of the squared acceleration.
struct Variances {
  std::vector<Row> rows;
  std::vector<double> variance;
  std::vector<bool> goes_on;  ///< the slide of the block before
};

/// Square of the second difference of a rounding error, over that of one that is new in every row, where a
/// row goes so far: at a whole number of counts the error is the same in all of them. 1 where the encoder's
/// count is not stated.
double RoundingAt(double distance, double count) {
  if (!(count > 0.0)) return 1.0;
  const double counts_per_row = distance / count;
  const double part = counts_per_row - std::floor(counts_per_row);
  return std::min(part, 1.0 - part) / kMeanDistanceToWhole;
}

Variances BlockVariances(const Problem& problem, const Fit& fit) {
  const Signals& s = *problem.signals;
  // Slower than this, quantisation is no noise of constant variance; faster, it does not grow with the speed.
  const double slowest = kJitter.slowest_counts_per_row * problem.stated.position_step / problem.log.period_s;
  Variances out;
  std::size_t next = 0;
  for (std::size_t from = 2; from + kBlock <= problem.rows(); from += kBlock) {
    double sum = 0.0, w2 = 0.0, a2 = 0.0, rounding = 0.0;
    bool use = true;
    for (std::size_t k = from; k < from + kBlock && use; ++k) {
      use = problem.counted[k] != 0 && problem.counted[k - 2] != 0 && problem.root_weight[k] > 0.0 &&
            problem.root_weight[k - 1] > 0.0 && problem.root_weight[k - 2] > 0.0 &&
            std::fabs(s.velocity[k]) > slowest;
      if (!use) break;
      const auto at = [&](std::size_t i) { return fit.residual[i] / problem.root_weight[i]; };
      const double d = at(k) - 2.0 * at(k - 1) + at(k - 2);
      sum += d * d / kVarianceOfSecondDifference;
      rounding += RoundingAt(std::fabs(s.velocity[k]) * problem.log.period_s, problem.stated.position_step);
      w2 += s.velocity[k] * s.velocity[k];
      a2 += s.acceleration[k] * s.acceleration[k];
    }
    if (!use) continue;
    const double n = kBlock;
    Row row = Row::Zero();
    row(static_cast<Eigen::Index>(from * kParts / problem.rows())) = 1.0;
    row(kSpeed) = w2 / n;
    row(kAcceleration) = a2 / n;
    row(kRounding) = rounding / n - 1.0;
    out.goes_on.push_back(from == next);
    next = from + kBlock;
    out.rows.push_back(row);
    out.variance.push_back(sum / n);
  }
  return out;
}

struct WeightedFit {
  Row c;
  Square covariance;
};

struct Levels {
  Row c;
  Square inverse;
};

/// The normal equations, with none below its least: those that would be are held there.
Levels SolveFrom(const Square& normal, const Row& right, const Row& least) {
  std::array<bool, kColumns> held{};
  for (;;) {
    Square free = normal;
    Row rest = right;
    for (int i = 0; i < kColumns; ++i)
      if (held[static_cast<std::size_t>(i)]) rest -= least(i) * normal.col(i);
    for (int i = 0; i < kColumns; ++i) {
      if (!held[static_cast<std::size_t>(i)]) continue;
      free.row(i).setZero();
      free.col(i).setZero();
      free(i, i) = 1.0;
      rest(i) = least(i);
    }
    Levels out;
    out.inverse = free.inverse();
    out.c = out.inverse * rest;
    bool settled = true;
    for (int i = 0; i < kColumns; ++i) {
      bool& holds = held[static_cast<std::size_t>(i)];
      if (holds) out.inverse(i, i) = 0.0;
      // A part without rows has no level.
      if (holds || !(out.c(i) < least(i)) || !(normal(i, i) > kNoRows)) continue;
      holds = true;
      settled = false;
    }
    if (settled) return out;
  }
}

/// Of sums over blocks that are one datum: their squares.
Square ScatterOf(const std::vector<Row>& gradients, const std::vector<std::size_t>& datum) {
  std::map<std::size_t, Row> sums;
  for (std::size_t i = 0; i < gradients.size(); ++i)
    sums.try_emplace(datum[i], Row::Zero()).first->second += gradients[i];
  Square out = Square::Zero();
  for (const auto& [at, sum] : sums) out += sum * sum.transpose();
  return out;
}

/// What may be one datum: a block; a slide, or a speed, at which the rounding is alike from block to block.
std::vector<std::vector<std::size_t>> Data(const Variances& blocks) {
  std::vector<std::size_t> of_blocks, of_slides, of_speeds;
  double fastest = 0.0;
  for (const Row& r : blocks.rows) fastest = std::max(fastest, r(kSpeed));
  std::size_t slide = 0;
  for (std::size_t i = 0; i < blocks.rows.size(); ++i) {
    if (!blocks.goes_on[i]) ++slide;
    of_blocks.push_back(i);
    of_slides.push_back(slide);
    of_speeds.push_back(
        static_cast<std::size_t>(kScreening.bins * std::sqrt(blocks.rows[i](kSpeed) / fastest)));
  }
  return {std::move(of_blocks), std::move(of_slides), std::move(of_speeds)};
}

/// Least squares with weights that follow the variance; the covariance as the data scatter, where the speed's
/// share scatters most. `count`: what an error of the reading of one count makes. Levels below what the
/// rounding makes of it leave the speed more than there is.
WeightedFit FitVariances(const Variances& blocks, double count) {
  std::vector<Row> rows = blocks.rows;
  Row least = Row::Constant(-std::numeric_limits<double>::infinity());
  least.head<kParts>().setConstant(count * kUniformVariance);
  least(kRounding) = 0.0;
  const std::vector<double>& variance = blocks.variance;
  Row c = Row::Zero();
  c.head<kParts>().setOnes();
  Square inverse = Square::Identity();
  std::vector<Row> gradients(rows.size());
  std::vector<double> sorted = variance;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double middle = sorted[sorted.size() / 2];
  for (int pass = 0; pass < kParts; ++pass) {
    Square normal = Square::Identity() * kNoRows;
    Row right = Row::Zero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      // Jitter itself makes the rounding new in every row: of two rows' fundamentals exp(-(2 pi s)^2) is
      // left.
      const double jitter =
          pass == 0 || !(count > 0.0) ? 0.0 : std::max(0.0, c(kSpeed) * rows[i](kSpeed)) / count;
      rows[i](kRounding) =
          blocks.rows[i](kRounding) * std::exp(-std::pow(2.0 * std::numbers::pi, 2) * jitter);
      const double expected =
          std::max(pass == 0 ? middle : rows[i].dot(c), middle / kScreening.most_overdispersion);
      const double weight = 1.0 / (expected * expected);
      // A block with a shock in it counts as far as it may be chance.
      const double seen = std::min(variance[i], kScreening.most_overdispersion * expected);
      normal += weight * rows[i] * rows[i].transpose();
      right += weight * seen * rows[i];
      gradients[i] = weight * (seen - rows[i].dot(c)) * rows[i];
    }
    const Levels levels = SolveFrom(normal, right, least);
    inverse = levels.inverse;
    c = levels.c;
  }
  WeightedFit out{c, Square::Zero()};
  for (const std::vector<std::size_t>& datum : Data(blocks)) {
    const Square covariance = inverse * ScatterOf(gradients, datum) * inverse;
    if (covariance(kSpeed, kSpeed) > out.covariance(kSpeed, kSpeed)) out.covariance = covariance;
  }
  return out;
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
  Variances blocks = BlockVariances(problem, fit);
  std::vector<Row>& rows = blocks.rows;
  Jitter out;
  if (rows.size() < static_cast<std::size_t>(kScreening.blocks)) return out;
  Row top = Row::Constant(1e-300);
  for (const auto& r : rows) top = top.cwiseMax(r);
  top(kRounding) = 1.0;
  double low = 1.0;
  for (auto& r : rows) {
    r = r.cwiseQuotient(top).eval();
    low = std::min(low, r(kSpeed));
  }
  if (low > 0.5 * 0.5) return out;
  out.tested = true;
  const double gain = GainOfReading(problem);
  const auto [c, covariance] =
      FitVariances(blocks, gain * problem.stated.position_step * problem.stated.position_step);
  const double sigma = std::sqrt(std::max(covariance(kSpeed, kSpeed), 1e-300));
  out.drop = c(kSpeed) > 0.0 ? std::pow(c(kSpeed) / sigma, 2) : 0.0;
  const double per = gain * top(kSpeed);
  out.sigma_s2 = sigma / per;
  out.rms_s = std::sqrt(std::max(c(kSpeed), 0.0) / per);
  out.sigma_s = 0.5 * sigma / per / std::max(out.rms_s, std::sqrt(sigma / per));
  return out;
}

}  // namespace contour::diagnosis
