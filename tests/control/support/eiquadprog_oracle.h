#pragma once

#include <Eigen/Dense>
#include <eiquadprog/eiquadprog-rt.hpp>
#include <memory>
#include <optional>

#include "tests/control/support/dense_qp.h"

namespace contour::test {

/// Goldfarb and Idnani's dual method from the eiquadprog package (header only, fixed size).
template <int Variables, int Rows>
class EiquadprogOracle {
 public:
  std::optional<Eigen::VectorXd> Solve(const DenseQp& qp) {
    const double scale = qp.hessian.trace() / Variables;
    hessian_ = qp.hessian / scale;
    gradient_ = qp.gradient / scale;
    inequality_ << qp.constraint, -qp.constraint;
    offset_ << -qp.lower, qp.upper;
    const auto status =
        solver_.solve_quadprog(hessian_, gradient_, equality_, equality_offset_, inequality_, offset_, x_);
    if (status != eiquadprog::solvers::RT_EIQUADPROG_OPTIMAL) return std::nullopt;
    return Eigen::VectorXd(x_);
  }

 private:
  eiquadprog::solvers::RtEiquadprog<Variables, 0, 2 * Rows> solver_;
  Eigen::Matrix<double, Variables, Variables> hessian_;
  Eigen::Matrix<double, Variables, 1> gradient_, x_;
  Eigen::Matrix<double, 0, Variables> equality_;
  Eigen::Matrix<double, 0, 1> equality_offset_;
  Eigen::Matrix<double, 2 * Rows, Variables> inequality_;
  Eigen::Matrix<double, 2 * Rows, 1> offset_;
};

}  // namespace contour::test
