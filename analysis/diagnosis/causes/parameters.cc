#include "analysis/diagnosis/causes/parameters.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/stroke_shapes.h"
#include "analysis/diagnosis/tuning/statistics.h"

namespace contour::diagnosis {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr int kDraws = 400;

void AddShape(const Problem& problem, const Fit& fit, std::size_t index, std::size_t first, Cause& cause) {
  const StrokeShape* shape = CauseNamed(fit.point.effects[index]->kind).shape;
  // A wave of the angle is told by its amplitudes.
  if (shape == nullptr || fit.point.effects[index]->order > 0.0) return;
  const std::vector<double>& a = fit.point.amplitudes[index];
  ShapeTable t;
  t.abscissa = "position_mm";
  t.ordinate = *shape->ordinate;
  const double unit = shape->per_unit;
  const Signals& s = *problem.signals;
  const std::vector<double> grid = StrokeGrid(s);
  const auto n = static_cast<Eigen::Index>(a.size());
  const Eigen::MatrixXd c =
      fit.covariance.block(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(first), n, n);
  std::vector<Signal> columns;
  for (std::size_t j = 0; j < a.size(); ++j) {
    std::vector<double> one(a.size(), 0.0);
    one[j] = 1.0;
    columns.push_back(OverStroke(s, one, shape->basis, grid));
  }
  const Signal y = OverStroke(s, a, shape->basis, grid);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    Eigen::VectorXd v(n);
    for (Eigen::Index j = 0; j < n; ++j) v(j) = columns[static_cast<std::size_t>(j)][i];
    t.x.push_back(1e3 * (grid[i] + s.middle_m));
    t.y.push_back(unit * y[i]);
    t.sigma.push_back(unit * std::sqrt(std::max(0.0, v.dot(c * v))));
  }
  cause.shapes.push_back(std::move(t));
}

}  // namespace

void DescribeEffect(const Problem& problem, const Fit& fit, std::size_t index, const Eigen::MatrixXd& draws,
                    Cause& cause) {
  const auto parameters = *CauseNamed(fit.point.effects[index]->kind).parameters;
  cause.parameters.clear();
  cause.shapes.clear();
  std::size_t first = fit.point.base.size();
  for (std::size_t e = 0; e < index; ++e) first += fit.point.amplitudes[e].size();
  std::map<std::string, std::vector<double>> drawn;
  // The whole point is drawn: parameters such as a stiffness depend on the base's values too.
  for (Eigen::Index d = 0; d < draws.cols(); ++d) {
    Point p = Moved(fit.point, draws.col(d));
    p.effects = {p.effects[index]};
    p.amplitudes = {std::vector<double>(p.amplitudes[index])};
    for (const auto& [name, v] : parameters({problem, p, 0})) drawn[name].push_back(v);
  }
  const auto count = static_cast<double>(draws.cols());
  for (const auto& [name, v] : parameters({problem, fit.point, index})) {
    std::vector<double>& d = drawn[name];
    if (name == "phase_rad")
      for (double& x : d) x = v + std::remainder(x - v, kTwoPi);
    std::sort(d.begin(), d.end());
    const auto tail = static_cast<std::size_t>(count * kTail95);
    const double low = d[tail], high = d[d.size() - 1 - tail];
    // A peak of noisy amplitudes is drawn too large on the average: turned over about the value. What is a
    // logarithm in the fit (a Stribeck speed, a stiffness) has its longer side upwards as drawn.
    const bool peak = name.starts_with("amplitude");
    cause.parameters[name] = peak ? Interval{v, 2.0 * v - high, 2.0 * v - low} : Interval{v, low, high};
  }
  AddShape(problem, fit, index, first, cause);
}

void DescribeEffect(const Problem& problem, const Fit& fit, std::size_t index, Cause& cause) {
  const Eigen::Index n = fit.covariance.rows();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 *
                                                             (fit.covariance + fit.covariance.transpose()));
  const Eigen::MatrixXd root =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::mt19937_64 random(20240229);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd draws(n, kDraws);
  for (Eigen::Index d = 0; d < kDraws; ++d) {
    for (Eigen::Index i = 0; i < n; ++i) draws(i, d) = normal(random);
    draws.col(d) = (root * draws.col(d)).eval();
  }
  DescribeEffect(problem, fit, index, draws, cause);
}

}  // namespace contour::diagnosis
