#include "analysis/axis_model/axis_model.h"

#include <gtest/gtest.h>

namespace contour::diagnosis {
namespace {

StatedAxis Stated() {
  StatedAxis s;
  s.two_inertia = s.friction_on_load = true;
  s.motor_inertia = 5e-5;
  s.load_inertia = 6e-6;
  s.stiffness = 25.0;
  s.damping = 1e-3;
  s.friction = {0.03, 0.031, 0.04, 0.041, 2.0, 1.0, 3.0, 2e-3, 2.5, 3e-4};
  s.offset = 0.01;
  s.delay_s = 1e-3;
  s.lag_s = 2e-4;
  return s;
}

TEST(AxisModel, HasTheNumbersThatAreStatedAndNoEffects) {
  const AxisModel m = ModelOf(Stated());
  EXPECT_TRUE(m.two_inertia && m.friction_on_load);
  EXPECT_EQ(m.motor_inertia, 5e-5);
  EXPECT_EQ(m.load_inertia, 6e-6);
  EXPECT_EQ(m.stiffness, 25.0);
  EXPECT_EQ(m.damping, 1e-3);
  EXPECT_EQ(m.friction, Stated().friction);
  EXPECT_EQ(m.offset, 0.01);
  EXPECT_EQ(m.delay_s, 1e-3);
  EXPECT_EQ(m.lag_s, 2e-4);
  EXPECT_EQ(m.torque_gain, 1.0);
  EXPECT_EQ(m.gap, 0.0);
  EXPECT_FALSE(m.motor_force || m.load_force || m.level || m.viscous || m.reading_error || m.scale_error_m);
}

TEST(AxisModel, ARigidAxisHasItsFrictionOnTheOneBody) {
  StatedAxis s = Stated();
  s.two_inertia = false;
  EXPECT_FALSE(ModelOf(s).friction_on_load);
}

}  // namespace
}  // namespace contour::diagnosis
