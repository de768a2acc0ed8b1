#pragma once

#include <Eigen/Core>
#include <functional>

namespace contour::diagnosis {

/// Residual over parameters with priors, for a fit by differences: the maximum a posteriori point is where
/// |r(x)|^2 + sum of (x / sigma)^2 is least.
struct LeastSquares {
  /// Of x; called from several threads at once.
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> residual;
  /// The same of each column, where that is cheaper together. May be empty.
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)> residuals;
  Eigen::VectorXd sigma;    ///< of the priors, which are about 0
  Eigen::VectorXd step;     ///< of each parameter, for differences
  Eigen::VectorXd longest;  ///< move of each parameter in one step of the fit
  int threads = 1;

  [[nodiscard]] double PriorAt(const Eigen::VectorXd& x) const;
  /// Columns of forward differences. `at_x` is the residual at x.
  [[nodiscard]] Eigen::MatrixXd Jacobian(const Eigen::VectorXd& x, const Eigen::VectorXd& at_x) const;
  /// J'J and the priors.
  [[nodiscard]] Eigen::MatrixXd Normal(const Eigen::MatrixXd& jacobian) const;
};

struct MarquardtEffort {
  int most_iterations = 12;
  double enough = 5e-5;  ///< ends where an iteration gains less than this share of the cost
};

/// By Levenberg and Marquardt (SIAM Journal 11(2), 1963), from x, which moves. Returns how many residuals it
/// asked for.
int FitByMarquardt(const LeastSquares& problem, const MarquardtEffort& effort, Eigen::VectorXd& x);

}  // namespace contour::diagnosis
