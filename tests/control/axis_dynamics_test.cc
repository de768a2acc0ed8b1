#include "control/axis_dynamics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace contour {
namespace {

constexpr double kPeriod = 1e-3;

struct State {
  double position_m, velocity_m_s, force_m_s2;
};

// The differential equations of AxisDynamics in small steps of the fourth-order Runge-Kutta method.
State Integrate(State s, double command, double known, double lag_s, double viscous_1_s) {
  const int steps = 20000;
  const double h = kPeriod / steps;
  const auto rate = [&](const State& x) {
    return State{x.velocity_m_s, x.force_m_s2 + known - viscous_1_s * x.velocity_m_s,
                 (command - x.force_m_s2) / lag_s};
  };
  const auto ahead = [](const State& x, const State& r, double dt) {
    return State{x.position_m + dt * r.position_m, x.velocity_m_s + dt * r.velocity_m_s,
                 x.force_m_s2 + dt * r.force_m_s2};
  };
  for (int i = 0; i < steps; ++i) {
    const State k1 = rate(s), k2 = rate(ahead(s, k1, 0.5 * h)), k3 = rate(ahead(s, k2, 0.5 * h));
    const State k4 = rate(ahead(s, k3, h));
    s = ahead(ahead(ahead(ahead(s, k1, h / 6.0), k2, h / 3.0), k3, h / 3.0), k4, h / 6.0);
  }
  return s;
}

TEST(AxisDynamics, IsTheSolutionOfTheDifferentialEquations) {
  for (const double lag : {1e-4, 2e-4, 4e-4}) {
    for (const double viscous : {0.0, 5.6, 300.0}) {
      const AxisDynamics d = DiscretizeAxis(kPeriod, lag, viscous);
      const double command = 3.0, previous = -2.0, known = 0.7;
      const State end = Integrate({0.01, 0.05, previous}, command, known, lag, viscous);
      EXPECT_NEAR(end.position_m,
                  0.01 + d.position_from_velocity * 0.05 + d.position_from_command * command +
                      d.position_from_previous * previous + d.position_from_known * known,
                  1e-15);
      EXPECT_NEAR(end.velocity_m_s,
                  d.velocity_kept * 0.05 + d.velocity_from_command * command +
                      d.velocity_from_previous * previous + d.velocity_from_known * known,
                  1e-12);
    }
  }
}

TEST(AxisDynamics, LagSharesTheForceBetweenThisCommandAndTheLast) {
  const AxisDynamics d = DiscretizeAxis(kPeriod, 2e-4, 0.0);
  // 0.2 (1 - exp(-5)) of the force of the interval before.
  EXPECT_NEAR(d.velocity_from_previous / kPeriod, 0.19865, 1e-5);
  EXPECT_NEAR(d.velocity_from_command + d.velocity_from_previous, kPeriod, 1e-18);
  EXPECT_NEAR(d.position_from_command + d.position_from_previous, 0.5 * kPeriod * kPeriod, 1e-21);
}

TEST(AxisDynamics, WithoutLagTheCommandActsAtOnce) {
  const AxisDynamics d = DiscretizeAxis(kPeriod, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(d.velocity_from_command, kPeriod);
  EXPECT_DOUBLE_EQ(d.position_from_command, 0.5 * kPeriod * kPeriod);
  EXPECT_EQ(d.velocity_from_previous, 0.0);
  EXPECT_EQ(d.position_from_previous, 0.0);
}

TEST(AxisDynamics, RefusesNonsense) {
  EXPECT_THROW(DiscretizeAxis(0.0, 2e-4, 0.0), std::invalid_argument);
  EXPECT_THROW(DiscretizeAxis(kPeriod, -1e-4, 0.0), std::invalid_argument);
  EXPECT_THROW(DiscretizeAxis(kPeriod, 2e-4, -1.0), std::invalid_argument);
}

}  // namespace
}  // namespace contour
