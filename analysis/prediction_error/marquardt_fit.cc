#include "analysis/prediction_error/marquardt_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "analysis/parallel/parallel_for.h"

namespace contour::diagnosis {
namespace {

constexpr int kMostAttempts = 8;
constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-7, kLess = 0.2, kMore = 8.0;

/// The step that a damping leaves, cut to what the parameters may move.
Eigen::VectorXd DampedStep(const LeastSquares& problem, const Eigen::MatrixXd& normal,
                           const Eigen::VectorXd& gradient, double damping) {
  Eigen::MatrixXd damped = normal;
  damped.diagonal() += damping * normal.diagonal();
  Eigen::VectorXd step = -damped.ldlt().solve(gradient);
  const double most = step.cwiseAbs().cwiseQuotient(problem.longest).maxCoeff();
  if (most > 1.0) step /= most;
  return step;
}

}  // namespace

double LeastSquares::PriorAt(const Eigen::VectorXd& x) const { return x.cwiseQuotient(sigma).squaredNorm(); }

Eigen::MatrixXd LeastSquares::Jacobian(const Eigen::VectorXd& x, const Eigen::VectorXd& at_x) const {
  if (residuals) {
    Eigen::MatrixXd moved = x.replicate(1, x.size());
    moved.diagonal() += step;
    Eigen::MatrixXd jacobian = residuals(moved);
    for (Eigen::Index i = 0; i < x.size(); ++i) jacobian.col(i) = (jacobian.col(i) - at_x) / step(i);
    return jacobian;
  }
  Eigen::MatrixXd jacobian(at_x.size(), x.size());
  ParallelFor(static_cast<std::size_t>(x.size()), threads, [&](std::size_t column) {
    const auto i = static_cast<Eigen::Index>(column);
    Eigen::VectorXd moved = x;
    moved(i) += step(i);
    jacobian.col(i) = (residual(moved) - at_x) / step(i);
  });
  return jacobian;
}

Eigen::MatrixXd LeastSquares::Normal(const Eigen::MatrixXd& jacobian) const {
  Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  normal.diagonal() += sigma.cwiseAbs2().cwiseInverse();
  return normal;
}

int FitByMarquardt(const LeastSquares& problem, const MarquardtEffort& effort, Eigen::VectorXd& x) {
  Eigen::VectorXd r = problem.residual(x);
  double cost = r.squaredNorm() + problem.PriorAt(x);
  double damping = kFirstDamping;
  int evaluations = 0;
  for (int i = 0; i < effort.most_iterations; ++i) {
    const Eigen::MatrixXd jacobian = problem.Jacobian(x, r);
    evaluations += static_cast<int>(x.size());
    const Eigen::MatrixXd normal = problem.Normal(jacobian);
    const Eigen::VectorXd gradient = jacobian.transpose() * r + x.cwiseQuotient(problem.sigma.cwiseAbs2());
    double gained = 0.0;
    for (int attempt = 0; attempt < kMostAttempts && gained <= 0.0; ++attempt) {
      const Eigen::VectorXd tried = x + DampedStep(problem, normal, gradient, damping);
      Eigen::VectorXd r_tried = problem.residual(tried);
      ++evaluations;
      const double cost_tried = r_tried.squaredNorm() + problem.PriorAt(tried);
      if (!(cost_tried < cost)) {
        damping *= kMore;
        continue;
      }
      gained = cost - cost_tried;
      x = tried;
      r = std::move(r_tried);
      cost = cost_tried;
      damping = std::max(kLeastDamping, damping * kLess);
    }
    if (gained <= 0.0 || gained < effort.enough * cost) break;
  }
  return evaluations;
}

}  // namespace contour::diagnosis
