#include "analysis/diagnosis/decision/held_out.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "analysis/diagnosis/decision/residual_trace.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/diagnosis/tuning/statistics.h"

namespace contour::diagnosis {
namespace {

constexpr std::size_t kHeldOutBlocks = kAcceptance.held_out_blocks;
constexpr std::size_t kUnseenBlocks = kBlocks;
// Factors on a diagonal: one holds a parameter, one keeps a solver away from zero.
constexpr double kHeld = 1e12, kRidge = 1.0 + 1e-12;
constexpr unsigned kSeed = 77;

// A shape's own number, such as an instant, may be in one block only: it stays.
void HoldShapes(const Fit& fit, Eigen::MatrixXd& normal) {
  auto j = static_cast<Eigen::Index>(fit.point.base.size());
  for (std::size_t e = 0; e < fit.point.effects.size(); ++e)
    for (std::size_t i = 0; i < fit.point.amplitudes[e].size(); ++i, ++j)
      if (i >= fit.point.effects[e]->tested) normal(j, j) *= kHeld;
}

// Where the parameters go to first order when the blocks of one fold are left out, for either fold.
std::vector<Eigen::VectorXd> StepsWithout(const Problem& problem, const Fit& fit) {
  const std::size_t n = problem.rows(), parts = problem.data_size() / n;
  const Eigen::Index p = fit.jacobian.cols();
  std::vector<Eigen::VectorXd> steps;
  for (std::size_t fold = 0; fold < 2; ++fold) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(p, p);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(p);
    for (std::size_t i = 0; i < fit.point.base.size(); ++i) {
      const double w = std::pow(problem.terms[i].sigma, -2);
      const auto j = static_cast<Eigen::Index>(i);
      normal(j, j) += w;
      gradient(j) += w * fit.point.base[i];
    }
    for (std::size_t b = 0; b < kHeldOutBlocks; ++b) {
      if (b % 2 == fold) continue;
      for (std::size_t part = 0; part < parts; ++part) {
        const auto from = static_cast<Eigen::Index>(part * n + n * b / kHeldOutBlocks);
        const auto rows = static_cast<Eigen::Index>(n * (b + 1) / kHeldOutBlocks - n * b / kHeldOutBlocks);
        const auto j = fit.jacobian.middleRows(from, rows);
        const Eigen::Map<const Eigen::VectorXd> r(fit.residual.data() + from, rows);
        normal.noalias() += j.transpose() * j;
        gradient.noalias() += j.transpose() * r;
      }
    }
    normal.diagonal() *= kRidge;
    HoldShapes(fit, normal);
    steps.push_back(-normal.ldlt().solve(gradient));
  }
  return steps;
}

// Sum of squares of the residual in every block, each with the parameters of the fold that did not see it.
std::vector<double> HeldOutSquares(const Problem& problem, const Fit& fit, bool scale) {
  const std::size_t n = problem.rows();
  std::vector<Point> points;
  for (const Eigen::VectorXd& step : StepsWithout(problem, fit)) points.push_back(Moved(fit.point, step));
  const auto raw = problem.Raw(points);
  std::vector<double> squares(kHeldOutBlocks, 0.0);
  for (std::size_t fold = 0; fold < 2; ++fold) {
    const Signal r = scale ? Signal(raw[fold].begin() + static_cast<std::ptrdiff_t>(n), raw[fold].end())
                           : TorqueResidualFrom(problem, points[fold], raw[fold]);
    for (std::size_t b = fold; b < kHeldOutBlocks; b += 2)
      for (std::size_t k = n * b / kHeldOutBlocks; k < n * (b + 1) / kHeldOutBlocks; ++k)
        if (problem.counted[k] != 0) squares[b] += r[k] * r[k];
  }
  return squares;
}

// Sum of squares of the white residual in every block; unseen: to first order, with the parameters that all
// others ask for.
std::vector<double> WhiteSquares(const Problem& problem, const Fit& fit, bool unseen) {
  const std::size_t n = problem.rows(), parts = problem.data_size() / n;
  const Eigen::Index p = fit.jacobian.cols();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(p, p);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(p);
  for (std::size_t i = 0; i < fit.point.base.size(); ++i) {
    const double w = std::pow(problem.terms[i].sigma, -2);
    const auto j = static_cast<Eigen::Index>(i);
    normal(j, j) = w;
    gradient(j) = w * fit.point.base[i];
  }
  std::vector<Eigen::MatrixXd> normals(kUnseenBlocks, Eigen::MatrixXd::Zero(p, p));
  std::vector<Eigen::VectorXd> gradients(kUnseenBlocks, Eigen::VectorXd::Zero(p));
  std::vector<double> squares(kUnseenBlocks, 0.0);
  for (std::size_t b = 0; b < kUnseenBlocks; ++b) {
    for (std::size_t part = 0; part < parts; ++part) {
      const auto from = static_cast<Eigen::Index>(part * n + n * b / kUnseenBlocks);
      const auto rows = static_cast<Eigen::Index>(n * (b + 1) / kUnseenBlocks - n * b / kUnseenBlocks);
      const auto j = fit.jacobian.middleRows(from, rows);
      const Eigen::Map<const Eigen::VectorXd> r(fit.residual.data() + from, rows);
      normals[b].selfadjointView<Eigen::Lower>().rankUpdate(j.transpose());
      gradients[b].noalias() += j.transpose() * r;
      squares[b] += r.squaredNorm();
    }
    normals[b].triangularView<Eigen::StrictlyUpper>() = normals[b].transpose();
    normal += normals[b];
    gradient += gradients[b];
  }
  for (std::size_t b = 0; b < kUnseenBlocks && unseen; ++b) {
    Eigen::MatrixXd others = normal - normals[b];
    others.diagonal() *= kRidge;
    HoldShapes(fit, others);
    const Eigen::VectorXd step = -others.ldlt().solve(gradient - gradients[b]);
    squares[b] += 2.0 * step.dot(gradients[b]) + step.dot(normals[b] * step);
  }
  return squares;
}

}  // namespace

double Consistency(const Problem& problem, const Fit& without, const Fit& with, bool unseen) {
  const std::vector<double> before = WhiteSquares(problem, without, unseen);
  const std::vector<double> after = WhiteSquares(problem, with, unseen);
  double sum = 0.0, squares = 0.0;
  for (std::size_t b = 0; b < kUnseenBlocks; ++b) {
    sum += before[b] - after[b];
    squares += std::pow(before[b] - after[b], 2);
  }
  return sum / std::sqrt(squares + 1e-300);
}

void HeldOutGain(const Problem& problem, const Fit& without, const Fit& with, bool scale, Cause& cause,
                 std::vector<BlockGain>& blocks) {
  const std::vector<double> before = HeldOutSquares(problem, without, scale);
  const std::vector<double> after = HeldOutSquares(problem, with, scale);
  const double n = static_cast<double>(problem.rows()) / kHeldOutBlocks;
  double sum_before = 0.0, sum_after = 0.0;
  blocks.clear();
  for (std::size_t b = 0; b < kHeldOutBlocks; ++b) {
    sum_before += before[b];
    sum_after += after[b];
    const double gain = before[b] > 0.0 ? 1.0 - std::sqrt(after[b] / before[b]) : 0.0;
    blocks.push_back({static_cast<double>(b) * n * problem.log.period_s,
                      static_cast<double>(b + 1) * n * problem.log.period_s, gain});
  }
  const double unit = scale ? 1e6 : 1.0;
  cause.unit = scale ? "um" : (problem.log.linear ? "N" : "Nm");
  cause.heldout_rms_before = unit * std::sqrt(sum_before / (n * kHeldOutBlocks));
  cause.heldout_rms_after = unit * std::sqrt(sum_after / (n * kHeldOutBlocks));
  cause.heldout_gain = 1.0 - std::sqrt(sum_after / sum_before);
  std::mt19937_64 random(kSeed);
  std::vector<double> gains;
  for (std::size_t draw = 0; draw < kAcceptance.held_out_draws; ++draw) {
    double x = 0.0, y = 0.0;
    for (std::size_t b = 0; b < kHeldOutBlocks; ++b) {
      const std::size_t i = random() % kHeldOutBlocks;
      x += before[i];
      y += after[i];
    }
    gains.push_back(1.0 - std::sqrt(y / std::max(x, 1e-300)));
  }
  std::sort(gains.begin(), gains.end());
  cause.heldout_gain_low = gains[HeldOutDraw(kTail95)];
  cause.heldout_gain_high = gains[HeldOutDraw(1.0 - kTail95)];
}

}  // namespace contour::diagnosis
