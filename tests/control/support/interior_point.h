#pragma once

#include <Eigen/Dense>
#include <algorithm>

#include "tests/control/support/dense_qp.h"

namespace contour::test {

/// Dense primal-dual interior-point method (Mehrotra 1992; Nocedal and Wright, Numerical Optimization,
/// ch. 16.6): slow, and nothing in common with the solver under test. Returns x; `gap` says how good it is.
inline Eigen::VectorXd SolveByInteriorPoint(const DenseQp& qp, double* gap = nullptr) {
  using Eigen::Index;
  using Eigen::MatrixXd;
  using Eigen::VectorXd;
  const Index n = qp.hessian.rows();
  const Index m = 2 * qp.constraint.rows();
  // Unknowns in units of the bounds, cost in units of its mean curvature, so that one tolerance fits all.
  const double unit = std::max(qp.upper.maxCoeff() - qp.lower.minCoeff(), 1e-12);
  const double scale = qp.hessian.trace() / static_cast<double>(n);
  const MatrixXd h = qp.hessian / scale;
  const VectorXd g = qp.gradient / (scale * unit);
  MatrixXd a(m, n);
  a << qp.constraint, -qp.constraint;
  VectorXd b(m);
  b << qp.upper / unit, -qp.lower / unit;

  VectorXd x = VectorXd::Zero(n);
  VectorXd slack = (b - a * x).cwiseMax(0.1);
  VectorXd dual = VectorXd::Constant(m, 1.0);
  double mu = 1.0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const VectorXd dual_residual = h * x + g + a.transpose() * dual;
    const VectorXd primal_residual = a * x + slack - b;
    mu = slack.dot(dual) / static_cast<double>(m);
    const double residual =
        std::max(dual_residual.lpNorm<Eigen::Infinity>(), primal_residual.lpNorm<Eigen::Infinity>());
    if (mu < 1e-15 && residual < 1e-10) break;
    const VectorXd ratio = dual.cwiseQuotient(slack);
    const Eigen::LDLT<MatrixXd> kkt(h + a.transpose() * ratio.asDiagonal() * a);
    const auto direction = [&](const VectorXd& complementarity, VectorXd& dx, VectorXd& ds, VectorXd& dl) {
      // slack dl + dual ds = -complementarity
      const VectorXd c = complementarity.cwiseQuotient(slack);
      dx = kkt.solve(-dual_residual - a.transpose() * (ratio.cwiseProduct(primal_residual) - c));
      ds = -primal_residual - a * dx;
      dl = -c - ratio.cwiseProduct(ds);
    };
    const auto longest = [](const VectorXd& at, const VectorXd& change) {
      double length = 1.0;
      for (Index i = 0; i < at.size(); ++i) {
        if (change(i) < 0.0) length = std::min(length, -at(i) / change(i));
      }
      return length;
    };
    VectorXd dx, ds, dl;
    direction(slack.cwiseProduct(dual), dx, ds, dl);
    const double affine = std::min(longest(slack, ds), longest(dual, dl));
    const double mu_affine = (slack + affine * ds).dot(dual + affine * dl) / static_cast<double>(m);
    const double sigma = std::pow(mu_affine / mu, 3);
    direction(slack.cwiseProduct(dual) + ds.cwiseProduct(dl) - VectorXd::Constant(m, sigma * mu), dx, ds, dl);
    const double length = std::min(1.0, 0.995 * std::min(longest(slack, ds), longest(dual, dl)));
    x += length * dx;
    slack += length * ds;
    dual += length * dl;
  }
  if (gap != nullptr) *gap = mu;
  return x * unit;
}

}  // namespace contour::test
