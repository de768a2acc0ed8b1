#include "analysis/axis_model/linear_axis.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace contour::diagnosis {
namespace {

AxisModel TwoBodies() {
  AxisModel m;
  m.two_inertia = true;
  m.motor_inertia = 2.0;
  m.load_inertia = 3.0;
  m.stiffness = 1200.0;
  m.damping = 0.0;
  return m;
}

TEST(LinearAxis, RigidIsADoubleIntegratorWithDrag) {
  AxisModel m;
  m.motor_inertia = 4.0;
  const LinearAxis a = MakeLinearAxis(m, 8.0);
  EXPECT_EQ(a.states, 2);
  EXPECT_EQ(a.dynamics(0, 1), 1.0);
  EXPECT_EQ(a.dynamics(1, 1), -2.0);
  EXPECT_EQ(a.motor(1), 0.25);
  EXPECT_EQ(a.load.norm(), 0.0);
  EXPECT_EQ(a.dynamics.bottomRows(2).norm() + a.dynamics.rightCols(2).norm(), 0.0);
}

// w^2 = k (1 / jm + 1 / jl), and two zeros for the motion of both together.
TEST(LinearAxis, TwoBodiesSwingAtTheirResonance) {
  const LinearAxis a = MakeLinearAxis(TwoBodies(), 0.0);
  const Eigen::Vector4cd poles = a.dynamics.eigenvalues();
  double fastest = 0.0;
  for (int i = 0; i < 4; ++i) fastest = std::max(fastest, std::abs(poles(i)));
  EXPECT_NEAR(fastest, std::sqrt(1200.0 * (0.5 + 1.0 / 3.0)), 1e-9);
}

TEST(LinearAxis, InnerForcesLeaveTheMomentumAndFrictionTakesOfTheBodyThatRubs) {
  AxisModel m = TwoBodies();
  m.damping = 7.0;
  const Eigen::RowVector4d momentum(0.0, 2.0, 0.0, 3.0);
  EXPECT_LT((momentum * MakeLinearAxis(m, 0.0).dynamics).norm(), 1e-12);
  EXPECT_EQ(momentum * MakeLinearAxis(m, 5.0).dynamics, Eigen::RowVector4d(0.0, -5.0, 0.0, 0.0));
  m.friction_on_load = true;
  EXPECT_LT((momentum * MakeLinearAxis(m, 5.0).dynamics - Eigen::RowVector4d(0.0, 0.0, 0.0, -5.0)).norm(),
            1e-12);
  EXPECT_EQ(momentum * MakeLinearAxis(m, 0.0).motor, 1.0);
  EXPECT_EQ(momentum * MakeLinearAxis(m, 0.0).load, 1.0);
}

}  // namespace
}  // namespace contour::diagnosis
