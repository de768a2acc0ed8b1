#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "analysis/axis_model/linear_axis.h"
#include "analysis/prediction_error/forward_filter.h"
#include "analysis/prediction_error/steady_gain.h"

namespace contour::diagnosis {
ObserverGain SteadyObserverGain(const AxisModel& m, double period_s, double bandwidth_Hz) {
  const LinearAxis axis = MakeLinearAxis(m, m.friction.s2);
  const int n = axis.states;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + n / 2, n + n / 2);
  a.topLeftCorner(n, n) = axis.dynamics.topLeftCorner(n, n);
  a.col(n).head(n) = axis.motor.head(n);
  if (m.two_inertia) a.col(n + 1).head(n) = axis.load.head(n);
  const Eigen::MatrixXd e = (a * period_s).exp();
  const Eigen::MatrixXd f = e.topLeftCorner(n, n);
  const Eigen::MatrixXd b = e.topRightCorner(n, n / 2);
  // A double integrator under white torque of sd s, read with unit noise, closes at about
  // (s T^2 / J)^(1/2) / T.
  const double jm = m.motor_inertia;
  const double index = std::pow(2.0 * std::numbers::pi * bandwidth_Hz * period_s, 2);
  const double all = jm + (m.two_inertia ? m.load_inertia : 0.0);
  const double q = std::pow(index * all / (period_s * period_s), 2);
  Eigen::MatrixXd noise = Eigen::MatrixXd::Identity(n / 2, n / 2) * q;
  if (m.two_inertia) {
    noise(0, 0) *= jm / all;
    noise(1, 1) *= m.load_inertia / all;
  }
  const Eigen::MatrixXd qd = b * noise * b.transpose();
  const Eigen::VectorXd gain = SteadyGain(f, qd, 1.0, Eigen::MatrixXd::Identity(n, n) * 100.0);
  ObserverGain out{};
  for (int i = 0; i < n; ++i) out[static_cast<std::size_t>(i)] = gain(i);
  return out;
}

}  // namespace contour::diagnosis
