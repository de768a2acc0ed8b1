#include "tools/diagnosis/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace contour::diagnosis {
namespace {

double StepOf(const Problem& problem, const Point& p, std::size_t i) {
  if (i < p.base.size()) return problem.terms_[i].step;
  i -= p.base.size();
  for (std::size_t e = 0; e < p.effects.size(); ++e) {
    if (i < p.amplitudes[e].size()) return p.effects[e]->steps[i];
    i -= p.amplitudes[e].size();
  }
  return 0.0;
}

Point Moved(Point p, const Eigen::VectorXd& by) {
  Eigen::Index j = 0;
  for (double& x : p.base) x += by(j++);
  for (std::size_t e = 0; e < p.effects.size(); ++e)
    for (std::size_t i = 0; i < p.amplitudes[e].size(); ++i) {
      double& a = p.amplitudes[e][i];
      a += by(j++);
      if (!p.effects[e]->low.empty()) a = std::clamp(a, p.effects[e]->low[i], p.effects[e]->high[i]);
    }
  return p;
}

double PriorOf(const Problem& problem, const Point& p) {
  double sum = 0.0;
  for (std::size_t i = 0; i < p.base.size(); ++i) sum += std::pow(p.base[i] / problem.terms_[i].sigma, 2);
  return sum;
}

double SquareOf(const std::vector<double>& r) {
  return Eigen::Map<const Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(r.size())).squaredNorm();
}

}  // namespace

std::size_t ParameterCount(const Point& p) {
  std::size_t n = p.base.size();
  for (const auto& a : p.amplitudes) n += a.size();
  return n;
}

Fit FitPoint(const Problem& problem, Point start, const FitEffort& effort) {
  Fit fit;
  fit.point = std::move(start);
  const std::size_t n = ParameterCount(fit.point);
  const auto columns = static_cast<Eigen::Index>(n);
  const auto size = static_cast<Eigen::Index>(problem.data_size());
  fit.residual = problem.Residuals(std::span(&fit.point, 1))[0];
  fit.prior = PriorOf(problem, fit.point);
  fit.cost = SquareOf(fit.residual) + fit.prior;
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(columns);
  for (std::size_t i = 0; i < fit.point.base.size(); ++i)
    weight(static_cast<Eigen::Index>(i)) = std::pow(problem.terms_[i].sigma, -2);
  bool stale = true;
  Eigen::MatrixXd normal;
  int refreshes = 0;
  const auto refresh = [&](std::size_t from) {
    std::vector<Point> around(from);
    for (std::size_t i = from; i < n; ++i) {
      Eigen::VectorXd by = Eigen::VectorXd::Zero(columns);
      double step = StepOf(problem, fit.point, i);
      by(static_cast<Eigen::Index>(i)) = step;
      around.push_back(Moved(fit.point, by));
    }
    if (from == 0) fit.jacobian.resize(size, columns);
    for (std::size_t first = from; first < n; first += 8) {
      const std::size_t count = std::min<std::size_t>(8, n - first);
      const auto runs = problem.Residuals(std::span(around).subspan(first, count));
      for (std::size_t i = 0; i < count; ++i)
        fit.jacobian.col(static_cast<Eigen::Index>(first + i)) =
            (Eigen::Map<const Eigen::VectorXd>(runs[i].data(), size) -
             Eigen::Map<const Eigen::VectorXd>(fit.residual.data(), size)) /
            StepOf(problem, fit.point, first + i);
    }
    normal = fit.jacobian.transpose() * fit.jacobian;
    normal.diagonal() += weight;
    normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff() * 1e-6;
    stale = false;
    ++refreshes;
  };
  bool fresh = false;
  if (effort.warm != nullptr) {
    const Eigen::Index known = effort.warm->jacobian.cols();
    fit.jacobian.resize(size, columns);
    fit.jacobian.leftCols(known) = effort.warm->jacobian;
    refresh(static_cast<std::size_t>(known));
  }
  for (int step = 0; step < effort.most_steps; ++step) {
    fresh = stale && refreshes < effort.most_refreshes;
    if (fresh) refresh(0);
    const bool last_chance = fresh || refreshes >= effort.most_refreshes;
    const Eigen::VectorXd r = Eigen::Map<const Eigen::VectorXd>(fit.residual.data(), size);
    Eigen::VectorXd gradient = fit.jacobian.transpose() * r;
    for (std::size_t i = 0; i < fit.point.base.size(); ++i)
      gradient(static_cast<Eigen::Index>(i)) += weight(static_cast<Eigen::Index>(i)) * fit.point.base[i];
    const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
    const Eigen::VectorXd by = -solver.solve(gradient);
    const double promised = -gradient.dot(by);
    if (promised < effort.close_enough) {
      fit.converged = true;
      if (last_chance || promised < 0.5 * effort.close_enough) break;
    }
    // Shorter and longer steps ride along in the lanes that a single run leaves empty.
    std::vector<Point> tried;
    for (const double part : {1.0, 0.5, 0.15, 1.4}) tried.push_back(Moved(fit.point, part * by));
    std::vector<std::vector<double>> residuals = problem.Residuals(tried);
    std::size_t chosen = tried.size();
    const double before = fit.cost;
    for (std::size_t i = 0; i < tried.size(); ++i) {
      const double prior = PriorOf(problem, tried[i]);
      const double cost = SquareOf(residuals[i]) + prior;
      if (!std::isfinite(cost) || cost >= fit.cost) continue;
      chosen = i;
      fit.cost = cost;
      fit.prior = prior;
    }
    const bool better = chosen < tried.size();
    if (better) {
      if (before - fit.cost < 0.6 * promised || chosen > 0) stale = true;
      fit.point = std::move(tried[chosen]);
      fit.residual = std::move(residuals[chosen]);
    }
    if (!better) {
      if (last_chance) {
        fit.converged = true;
        break;
      }
      stale = true;
    }
  }
  if (effort.covariance && !fresh && refreshes < effort.most_refreshes + 1 && stale) refresh(0);
  fit.covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(columns, columns));
  return fit;
}

}  // namespace contour::diagnosis
