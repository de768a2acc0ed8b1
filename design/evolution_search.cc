#include "design/evolution_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace contour {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Hansen's table of default parameters (its table 1, without negative weights).
struct Defaults {
  Defaults(Eigen::Index dimension, int asked) {
    const auto n = static_cast<double>(dimension);
    population = asked > 0 ? asked : 4 + static_cast<Eigen::Index>(3.0 * std::log(n));
    const Eigen::Index parents = population / 2;
    weights.resize(parents);
    for (Eigen::Index i = 0; i < parents; ++i)
      weights(i) = std::log(0.5 * static_cast<double>(population + 1)) - std::log(static_cast<double>(i + 1));
    weights /= weights.sum();
    effective = 1.0 / weights.squaredNorm();
    step_memory = (effective + 2.0) / (n + effective + 5.0);
    step_damping = 1.0 + 2.0 * std::max(0.0, std::sqrt((effective - 1.0) / (n + 1.0)) - 1.0) + step_memory;
    path_memory = (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n);
    rank_one = 2.0 / ((n + 1.3) * (n + 1.3) + effective);
    rank_mu = std::min(1.0 - rank_one,
                       2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0) * (n + 2.0) + effective));
    normal_length = std::sqrt(n) * (1.0 - 0.25 / n + 1.0 / (21.0 * n * n));
  }
  Eigen::Index population = 0;
  Vector weights;
  double effective = 0.0, step_memory = 0.0, step_damping = 0.0, path_memory = 0.0;
  double rank_one = 0.0, rank_mu = 0.0, normal_length = 0.0;
};

/// Where the next points are drawn from.
struct Distribution {
  Vector mean, step_path, shape_path;
  Matrix covariance, axes;  // axes: eigenvectors, each times its standard deviation
  Matrix whitening;
  double step = 0.0;
  int generation = 0;

  void Decompose() {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance);
    const Vector deviation = solver.eigenvalues().cwiseMax(1e-20).cwiseSqrt();
    axes = solver.eigenvectors() * deviation.asDiagonal();
    whitening =
        solver.eigenvectors() * deviation.cwiseInverse().asDiagonal() * solver.eigenvectors().transpose();
  }
  void Move(const Defaults& p, const std::vector<Vector>& best_first) {
    const Vector before = mean;
    mean.setZero();
    for (Eigen::Index i = 0; i < p.weights.size(); ++i)
      mean += p.weights(i) * best_first[static_cast<std::size_t>(i)];
    const Vector moved = (mean - before) / step;
    step_path = (1.0 - p.step_memory) * step_path +
                std::sqrt(p.step_memory * (2.0 - p.step_memory) * p.effective) * (whitening * moved);
    ++generation;
    const double unbiased = std::sqrt(1.0 - std::pow(1.0 - p.step_memory, 2.0 * generation));
    const auto n = static_cast<double>(mean.size());
    const bool steady = step_path.norm() / unbiased / p.normal_length < 1.4 + 2.0 / (n + 1.0);
    shape_path = (1.0 - p.path_memory) * shape_path +
                 (steady ? std::sqrt(p.path_memory * (2.0 - p.path_memory) * p.effective) : 0.0) * moved;
    const double lost = steady ? 0.0 : p.rank_one * p.path_memory * (2.0 - p.path_memory);
    covariance =
        (1.0 - p.rank_one - p.rank_mu + lost) * covariance + p.rank_one * shape_path * shape_path.transpose();
    for (Eigen::Index i = 0; i < p.weights.size(); ++i) {
      const Vector y = (best_first[static_cast<std::size_t>(i)] - before) / step;
      covariance += p.rank_mu * p.weights(i) * y * y.transpose();
    }
    step *= std::exp(p.step_memory / p.step_damping * (step_path.norm() / p.normal_length - 1.0));
    step = std::min(step, 1.0);
    Decompose();
  }
};

}  // namespace

double PortableRandom::Uniform() noexcept {
  // splitmix64 (Steele, Lea, Flood 2014).
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1.0p-53;
}

double PortableRandom::Normal() noexcept {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * Uniform());
}

SearchResult EvolutionSearch(const std::function<double(const std::vector<double>&)>& cost,
                             const std::vector<double>& start, const EvolutionOptions& options) {
  const auto n = static_cast<Eigen::Index>(start.size());
  const Defaults p(n, options.population);
  PortableRandom random(options.seed);
  Distribution d;
  d.mean = Eigen::Map<const Vector>(start.data(), n);
  d.step_path = d.shape_path = Vector::Zero(n);
  d.covariance = Matrix::Identity(n, n);
  d.step = options.first_step;
  d.Decompose();

  SearchResult result;
  result.best = start;
  result.cost = std::numeric_limits<double>::infinity();
  const auto evaluate = [&](const Vector& at) {
    const Vector inside = at.cwiseMax(0.0).cwiseMin(1.0);
    std::vector<double> point(inside.data(), inside.data() + n);
    const double value = cost(point);
    ++result.evaluations;
    if (value < result.cost) {
      result.cost = value;
      result.best = std::move(point);
    }
    return value + (at - inside).squaredNorm() * 10.0;
  };
  std::vector<Vector> points(static_cast<std::size_t>(p.population));
  std::vector<double> costs(points.size());
  std::vector<std::size_t> order(points.size());
  while (result.evaluations + static_cast<int>(p.population) <= options.evaluations) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vector normal(n);
      for (double& x : normal) x = random.Normal();
      points[i] = d.mean + d.step * (d.axes * normal);
      costs[i] = evaluate(points[i]);
    }
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
    std::vector<Vector> best_first;
    for (const std::size_t i : order) best_first.push_back(points[i]);
    d.Move(p, best_first);
  }
  return result;
}

}  // namespace contour
