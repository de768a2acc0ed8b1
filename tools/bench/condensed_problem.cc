#include "tools/bench/condensed_problem.h"

namespace contour::bench {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Runs the drift state of one axis (control/qp_problem.h) through the horizon.
template <class Input, class Position>
Eigen::Vector2d Roll(const AxisDynamics& d, Eigen::Vector2d drift, Index n, const Input& input,
                     const Position& position) {
  for (Index j = 0; j < n; ++j) {
    const double u = input(j);
    const double p = drift(0) + d.position_from_command * u;
    const double v = drift(1) + d.velocity_from_command * u;
    position(j, p);
    drift = {p + d.position_from_velocity * v + d.position_from_previous * u,
             d.velocity_kept * v + d.velocity_from_previous * u};
  }
  return drift;
}

}  // namespace

CondensedProblem::CondensedProblem(const QpProblem<2>& any) : n_(static_cast<Index>(any.horizon)) {
  hessian.resize(2 * n_, 2 * n_);
  gradient.resize(2 * n_);
  lower.resize(2 * n_);
  upper.resize(2 * n_);
  block_.resize(n_, n_);
  for (std::size_t i = 0; i < 2; ++i) {
    response_[i] = RowMajor::Zero(n_, n_);
    last_[i] = MatrixXd::Zero(2, n_);
    free_[i].resize(n_);
    for (Index c = 0; c < n_; ++c)
      last_[i].col(c) = Roll(
          any.dynamics[i], {0.0, 0.0}, n_, [c](Index j) { return j == c ? 1.0 : 0.0; },
          [&](Index j, double p) { response_[i](j, c) = p; });
  }
}

void CondensedProblem::Condense(const QpProblem<2>& problem) {
  for (std::size_t i = 0; i < 2; ++i)
    free_last_[i] = Roll(
        problem.dynamics[i], {problem.start.position[i], problem.start.velocity[i]}, n_,
        [](Index) { return 0.0; }, [&](Index j, double p) { free_[i](j) = p; });
  gradient.setZero();
  for (Index i = 0; i < 2; ++i) {
    for (Index k = 0; k < 2; ++k) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(k);
      const Eigen::Matrix2d terminal{{problem.terminal[a][b], problem.terminal[a][2 + b]},
                                     {problem.terminal[2 + a][b], problem.terminal[2 + a][2 + b]}};
      const Eigen::Vector2d pull = terminal * free_last_[k];
      for (Index j = 0; j < n_; ++j) {
        const double w = problem.stage[static_cast<std::size_t>(j)].weight[a][b];
        gradient.segment(i * n_, j + 1) += (w * free_[k](j)) * response_[i].row(j).head(j + 1).transpose();
      }
      gradient.segment(i * n_, n_).noalias() += last_[i].transpose() * pull;
      if (k >= i) AddBlock(problem, terminal, i, k);
    }
    for (Index j = 0; j < n_; ++j) {
      const auto a = static_cast<std::size_t>(i);
      const auto& stage = problem.stage[static_cast<std::size_t>(j)];
      hessian(i * n_ + j, i * n_ + j) += problem.effort[a];
      lower(i * n_ + j) = stage.lowest[a];
      upper(i * n_ + j) = stage.highest[a];
    }
  }
}

/// One outer product per stage, of the inputs that have acted by then: a third of n^3 multiplications.
void CondensedProblem::AddBlock(const QpProblem<2>& problem, const Eigen::Matrix2d& terminal, Index i,
                                Index k) {
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(k);
  const Eigen::Matrix<double, 2, Eigen::Dynamic> end = terminal * last_[k];
  for (Index c = 0; c < n_; ++c) block_.row(c) = last_[i](0, c) * end.row(0) + last_[i](1, c) * end.row(1);
  for (Index j = 0; j < n_; ++j) {
    const double w = problem.stage[static_cast<std::size_t>(j)].weight[a][b];
    const double* right = &response_[k](j, 0);
    for (Index c = 0; c <= j; ++c) {
      const double left = w * response_[i](j, c);
      double* row = &block_(c, 0);
      for (Index d = 0; d <= j; ++d) row[d] += left * right[d];
    }
  }
  hessian.block(i * n_, k * n_, n_, n_) = block_;
  if (k > i) hessian.block(k * n_, i * n_, n_, n_) = block_.transpose();
}

}  // namespace contour::bench
