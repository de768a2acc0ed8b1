#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "analysis/prediction_error/forward_filter.h"

namespace contour::diagnosis {
namespace {

Eigen::MatrixXd Exponential(Eigen::MatrixXd a) {
  const int halvings = 12;
  a /= std::ldexp(1.0, halvings);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(a.rows(), a.cols());
  Eigen::MatrixXd e = one + a * (one + a / 2.0 * (one + a / 3.0 * (one + a / 4.0)));
  for (int i = 0; i < halvings; ++i) e = (e * e).eval();
  return e;
}

}  // namespace

ObserverGain SteadyObserverGain(const AxisModel& m, double period_s, double bandwidth_Hz) {
  const int n = m.two_inertia ? 4 : 2;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + n / 2, n + n / 2);
  const double jm = m.motor_inertia;
  const double viscous = m.friction.s2;
  a(0, 1) = 1.0;
  if (m.two_inertia) {
    const double jl = m.load_inertia;
    a(2, 3) = 1.0;
    a(1, 0) = -m.stiffness / jm;
    a(1, 2) = m.stiffness / jm;
    a(1, 1) = -m.damping / jm;
    a(1, 3) = m.damping / jm;
    a(3, 0) = m.stiffness / jl;
    a(3, 2) = -m.stiffness / jl;
    a(3, 1) = m.damping / jl;
    a(3, 3) = -m.damping / jl;
    if (m.friction_on_load)
      a(3, 3) -= viscous / jl;
    else
      a(1, 1) -= viscous / jm;
    a(1, 4) = 1.0 / jm;
    a(3, 5) = 1.0 / jl;
  } else {
    a(1, 1) = -viscous / jm;
    a(1, 2) = 1.0 / jm;
  }
  const Eigen::MatrixXd e = Exponential(a * period_s);
  const Eigen::MatrixXd f = e.topLeftCorner(n, n);
  const Eigen::MatrixXd b = e.topRightCorner(n, n / 2);
  // A double integrator under white torque of sd s, read with unit noise, closes at about
  // (s T^2 / J)^(1/2) / T.
  const double index = std::pow(2.0 * std::numbers::pi * bandwidth_Hz * period_s, 2);
  const double all = jm + (m.two_inertia ? m.load_inertia : 0.0);
  const double q = std::pow(index * all / (period_s * period_s), 2);
  Eigen::MatrixXd noise = Eigen::MatrixXd::Identity(n / 2, n / 2) * q;
  if (m.two_inertia) {
    noise(0, 0) *= jm / all;
    noise(1, 1) *= m.load_inertia / all;
  }
  const Eigen::MatrixXd qd = b * noise * b.transpose();
  Eigen::MatrixXd p = Eigen::MatrixXd::Identity(n, n) * 100.0;
  Eigen::VectorXd gain = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < 4000; ++i) {
    const Eigen::VectorXd next = p.col(0) / (p(0, 0) + 1.0);
    const bool settled = i > 50 && (next - gain).norm() < 1e-12 * next.norm();
    gain = next;
    if (settled) break;
    p = (p - gain * p.row(0)).eval();
    p = (f * p * f.transpose() + qd).eval();
    p = (0.5 * (p + p.transpose())).eval();
  }
  ObserverGain out{};
  for (int i = 0; i < n; ++i) out[static_cast<std::size_t>(i)] = gain(i);
  return out;
}

}  // namespace contour::diagnosis
