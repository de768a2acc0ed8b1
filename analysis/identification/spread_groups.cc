#include "analysis/identification/spread_groups.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace contour::identify {
namespace {

/// Long enough for the slowest wave of a chirp, short against its sweep.
constexpr double kWindow_s = 0.03;
constexpr Eigen::Index kGroups[] = {8, 16};

/// First differences over the force itself, mean squares: 4 sin^2(pi f T) for a wave.
double Quickness(const std::vector<double>& force_N, std::size_t begin, std::size_t end) {
  const double n = static_cast<double>(end - begin);
  double mean = 0.0;
  for (std::size_t k = begin; k < end; ++k) mean += force_N[k] / n;
  double steps = 0.0, all = 1e-300;
  for (std::size_t k = begin; k < end; ++k) {
    all += std::pow(force_N[k] - mean, 2);
    if (k > begin) steps += std::pow(force_N[k] - force_N[k - 1], 2);
  }
  return steps / all;
}

}  // namespace

SpreadWindows WindowsOf(const std::vector<Measured>& records) {
  std::vector<double> force_N, position_m;
  for (const Measured& r : records) {
    const std::vector<double>& sent_N = r.led_by_drive() ? r.offset_N : r.force_N;
    for (std::size_t k = r.run_up; k < r.size(); ++k) {
      const double x = r.position_m[k];
      force_N.push_back(sent_N[k]);
      position_m.push_back(std::isfinite(x) || position_m.empty() ? x : position_m.back());
    }
  }
  SpreadWindows w;
  const double period_s = records.front().period_s;
  w.length = std::max<Eigen::Index>(2, std::lround(kWindow_s / period_s));
  const auto length = static_cast<std::size_t>(w.length);
  for (std::size_t begin = 0; begin < force_N.size(); begin += length) {
    const std::size_t end = std::min(begin + length, force_N.size());
    w.quickness.push_back(Quickness(force_N, begin, end));
    const double travel_m = position_m[end - 1] - position_m[begin];
    w.velocity_m_s.push_back(std::isfinite(travel_m) ? travel_m / (static_cast<double>(length) * period_s)
                                                     : 0.0);
  }
  return w;
}

double FewGroupsFactor(double groups) { return std::pow(1.0 + 1.2 / std::max(1.0, groups - 1.5), 2); }

Eigen::VectorXd ScatterOverGroups(const Eigen::MatrixXd& contributions, const std::vector<double>& key) {
  const Eigen::Index windows = contributions.rows();
  std::vector<Eigen::Index> order(static_cast<std::size_t>(windows));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return key[static_cast<std::size_t>(a)] < key[static_cast<std::size_t>(b)];
  });
  Eigen::VectorXd widest = Eigen::VectorXd::Zero(contributions.cols());
  for (const Eigen::Index groups : kGroups) {
    if (windows < 2 * groups) break;
    Eigen::VectorXd variance = Eigen::VectorXd::Zero(contributions.cols());
    for (Eigen::Index g = 0; g < groups; ++g) {
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(contributions.cols());
      for (Eigen::Index i = g * windows / groups; i < (g + 1) * windows / groups; ++i)
        sum += contributions.row(order[static_cast<std::size_t>(i)]);
      variance += sum.transpose().cwiseAbs2();
    }
    widest = widest.cwiseMax(variance * FewGroupsFactor(static_cast<double>(groups)));
  }
  return widest;
}

HalvesApart Disagreement(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual,
                         const Eigen::VectorXd& prior_sigma, double noise, const SpreadWindows& windows,
                         const std::vector<double>& key) {
  const Eigen::Index n = jacobian.cols();
  std::vector<double> sorted = key;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  // The prior is half of each.
  const Eigen::MatrixXd prior = 0.5 * prior_sigma.cwiseAbs2().cwiseInverse().asDiagonal().toDenseMatrix();
  Eigen::MatrixXd curvature[2] = {prior, prior};
  Eigen::VectorXd gradient[2] = {Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (std::size_t w = 0; w < key.size(); ++w) {
    const Eigen::Index begin = static_cast<Eigen::Index>(w) * windows.length;
    const Eigen::Index rows = std::min(windows.length, residual.size() - begin);
    const std::size_t half = key[w] < *middle ? 0 : 1;
    const auto j = jacobian.middleRows(begin, rows);
    curvature[half].noalias() += j.transpose() * j;
    gradient[half].noalias() += j.transpose() * residual.segment(begin, rows);
  }
  Eigen::VectorXd apart = Eigen::VectorXd::Zero(n), variance = Eigen::VectorXd::Zero(n);
  for (const std::size_t half : {std::size_t{0}, std::size_t{1}}) {
    const Eigen::LDLT<Eigen::MatrixXd> solver(curvature[half]);
    apart += (half == 0 ? 1.0 : -1.0) * solver.solve(gradient[half]);
    variance += noise * solver.solve(Eigen::MatrixXd::Identity(n, n)).diagonal();
  }
  return {apart.cwiseAbs(), apart.cwiseAbs().cwiseQuotient(variance.cwiseMax(1e-300).cwiseSqrt())};
}

}  // namespace contour::identify
