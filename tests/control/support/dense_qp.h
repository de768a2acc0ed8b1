#pragma once

#include <Eigen/Dense>

#include "control/qp_problem.h"

namespace contour::test {

/// 1/2 x' hessian x + gradient' x with x = (u_0, u_1, ..), rows lower <= constraint x <= upper.
struct DenseQp {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd constraint;
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

/// The same problem without its structure: every error as an affine function of all inputs, found by running
/// the physical model [position, velocity, previous input] once per unit input.
template <std::size_t Axes>
DenseQp Condense(const QpProblem<Axes>& problem) {
  using Eigen::Index;
  using Eigen::MatrixXd;
  using Eigen::VectorXd;
  const auto n = static_cast<Index>(problem.horizon);
  const auto axes = static_cast<Index>(Axes);
  const Index inputs = n * axes;
  DenseQp qp;
  qp.hessian = MatrixXd::Zero(inputs, inputs);
  qp.gradient = VectorXd::Zero(inputs);

  // Rows: position after each interval, per axis; and the drift state at the end.
  MatrixXd error(inputs, inputs + 1);
  MatrixXd last(2 * axes, inputs + 1);
  for (Index column = 0; column <= inputs; ++column) {
    const bool affine = column == inputs;
    for (Index i = 0; i < axes; ++i) {
      const auto a = static_cast<std::size_t>(i);
      const AxisDynamics& d = problem.dynamics[a];
      double p = 0.0, v = 0.0, before = 0.0;
      for (Index j = 0; j < n; ++j) {
        const auto s = static_cast<std::size_t>(j);
        const double u = column == j * axes + i ? 1.0 : 0.0;
        double next_p = p + d.position_from_velocity * v + d.position_from_previous * before;
        double next_v = d.velocity_kept * v + d.velocity_from_previous * before;
        if (affine && j == 0) next_p = problem.start.position[a];
        if (affine && j == 0) next_v = problem.start.velocity[a];
        if (affine && j > 0) next_p += problem.stage[s].position_defect[a];
        if (affine && j > 0) next_v += problem.stage[s].velocity_defect[a];
        p = next_p + d.position_from_command * u;
        v = next_v + d.velocity_from_command * u;
        before = u;
        error(j * axes + i, column) = p;
      }
      last(i, column) = p + d.position_from_velocity * v + d.position_from_previous * before;
      last(axes + i, column) = d.velocity_kept * v + d.velocity_from_previous * before;
    }
  }
  const auto add = [&](const MatrixXd& rows, const MatrixXd& weight) {
    const MatrixXd by_input = rows.leftCols(inputs);
    qp.hessian += by_input.transpose() * weight * by_input;
    qp.gradient += by_input.transpose() * weight * rows.col(inputs);
  };
  for (Index j = 0; j < n; ++j) {
    MatrixXd weight(axes, axes);
    for (Index i = 0; i < axes; ++i) {
      for (Index k = 0; k < axes; ++k) {
        weight(i, k) = problem.stage[static_cast<std::size_t>(j)]
                           .weight[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
      }
      qp.hessian(j * axes + i, j * axes + i) += problem.effort[static_cast<std::size_t>(i)];
    }
    add(error.middleRows(j * axes, axes), weight);
  }
  MatrixXd terminal(2 * axes, 2 * axes);
  for (Index i = 0; i < 2 * axes; ++i) {
    for (Index k = 0; k < 2 * axes; ++k) {
      terminal(i, k) = problem.terminal[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    }
  }
  add(last, terminal);

  Index rows = inputs;
  for (const bool limited : problem.has_rate_limit) rows += limited ? n : 0;
  qp.constraint = MatrixXd::Zero(rows, inputs);
  qp.lower = VectorXd::Zero(rows);
  qp.upper = VectorXd::Zero(rows);
  Index row = inputs;
  for (Index j = 0; j < n; ++j) {
    const auto& stage = problem.stage[static_cast<std::size_t>(j)];
    for (Index i = 0; i < axes; ++i) {
      const auto a = static_cast<std::size_t>(i);
      const Index at = j * axes + i;
      qp.constraint(at, at) = 1.0;
      qp.lower(at) = stage.lowest[a];
      qp.upper(at) = stage.highest[a];
      if (!problem.has_rate_limit[a]) continue;
      qp.constraint(row, at) = 1.0;
      qp.lower(row) = stage.lowest_step[a];
      qp.upper(row) = stage.highest_step[a];
      if (j > 0) {
        qp.constraint(row, at - axes) = -1.0;
      } else {
        qp.lower(row) += problem.previous[a];
        qp.upper(row) += problem.previous[a];
      }
      ++row;
    }
  }
  return qp;
}

}  // namespace contour::test
