#include "analysis/axis_model/seen_with_lever.h"

#include <gtest/gtest.h>

#include <cmath>

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

// Resonance, time constants, the level's force over the offset: what no unit changes.
TEST(SeenWithLever, InAnotherCoordinateTheMotionIsTheSame) {
  AxisModel a = ModelOf(Stated());
  a.gap = 1e-3;
  a.start_bristle = 2e-3;
  const double lever = 3.0;
  const AxisModel b = SeenWithLever(a, lever);
  const auto resonance = [](const AxisModel& m) {
    return std::sqrt(m.stiffness * (1.0 / m.motor_inertia + 1.0 / m.load_inertia));
  };
  EXPECT_NEAR(resonance(b) / resonance(a), 1.0, 1e-12);
  EXPECT_NEAR(b.friction.s2 / b.load_inertia, a.friction.s2 / a.load_inertia, 1e-9);
  EXPECT_NEAR(b.friction.Fc_plus / b.offset, a.friction.Fc_plus / a.offset, 1e-12);
  // q = x * lever: a speed w in q is w / lever in x, a force u in q is u * lever in x.
  EXPECT_DOUBLE_EQ(b.friction.vs, a.friction.vs / lever);
  EXPECT_DOUBLE_EQ(b.friction.vd, a.friction.vd / lever);
  EXPECT_DOUBLE_EQ(b.friction.Fs_minus, a.friction.Fs_minus * lever);
  EXPECT_DOUBLE_EQ(b.friction.s0, a.friction.s0 * lever * lever);
  EXPECT_DOUBLE_EQ(b.gap, a.gap / lever);
  EXPECT_DOUBLE_EQ(b.start_bristle * b.friction.s0, a.start_bristle * a.friction.s0 * lever);
  EXPECT_EQ(b.delay_s, a.delay_s);
  EXPECT_NEAR(SeenWithLever(b, 1.0 / lever).damping, a.damping, 1e-15);
}
}  // namespace
}  // namespace contour::diagnosis
