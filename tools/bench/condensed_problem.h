#pragma once

#include <Eigen/Dense>

#include "control/qp_problem.h"

namespace contour::bench {

/// A contour problem as library solvers take it: 1/2 x' hessian x + gradient' x, lower <= x <= upper, with
/// the inputs of axis 0 first, then those of axis 1. What the dynamics alone decide is computed once;
/// Condense does the rest, as a controller would have to in every cycle.
class CondensedProblem {
 public:
  explicit CondensedProblem(const QpProblem<2>& any);
  void Condense(const QpProblem<2>& problem);

  // Row-major or column-major are the same for a symmetric matrix.
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient, lower, upper;

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void AddBlock(const QpProblem<2>& problem, const Eigen::Matrix2d& terminal, Eigen::Index i, Eigen::Index k);

  RowMajor response_[2];     ///< positions after each interval by input, lower triangular
  Eigen::MatrixXd last_[2];  ///< drift position and velocity at the end by input
  RowMajor block_;
  Eigen::VectorXd free_[2];
  Eigen::Vector2d free_last_[2];
  Eigen::Index n_;
};

}  // namespace contour::bench
