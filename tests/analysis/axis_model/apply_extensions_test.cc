#include "analysis/axis_model/apply_extensions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace contour::diagnosis {
namespace {

StatedAxis Rigid() {
  StatedAxis a;
  a.motor_inertia = 6e-5;
  a.friction = {0.03, 0.03, 0.04, 0.04, 2.0, 1.0, 3.0, 2e-3, 0.0, 3e-4};
  a.delay_s = 1e-3;
  a.lag_s = 2e-4;
  return a;
}

TEST(ApplyNumbers, WithoutExtensionsNothingChanges) {
  StatedAxis a = Rigid();
  ApplyNumbers({}, a);
  EXPECT_EQ(a.friction, Rigid().friction);
  EXPECT_EQ(a.motor_inertia, Rigid().motor_inertia);
  EXPECT_FALSE(a.two_inertia);
}

TEST(ApplyNumbers, AComplianceSplitsTheInertiaAtItsAntiresonance) {
  ExtensionsConfig x;
  x.compliance.emplace();
  x.compliance->stiffness_Nm_rad = 20.0;
  x.compliance->antiresonance_Hz = 150.0;
  x.compliance->damping_ratio = 0.05;
  StatedAxis a = Rigid();
  ApplyNumbers(x, a);
  ASSERT_TRUE(a.two_inertia);
  EXPECT_NEAR(a.motor_inertia + a.load_inertia, 6e-5, 1e-18);
  EXPECT_NEAR(std::sqrt(a.stiffness / a.load_inertia) / (2.0 * std::numbers::pi), 150.0, 1e-9);
  // d = 2 zeta w J of the mode, w^2 = k / J with J the reduced inertia.
  const double reduced = a.motor_inertia * a.load_inertia / 6e-5;
  EXPECT_NEAR(a.damping / (2.0 * std::sqrt(a.stiffness * reduced)), 0.05, 1e-12);
}

TEST(ApplyNumbers, AComplianceThatWouldTakeTheWholeInertiaIsNone) {
  ExtensionsConfig x;
  x.compliance.emplace();
  x.compliance->stiffness_Nm_rad = 20.0;
  x.compliance->antiresonance_Hz = 10.0;
  StatedAxis a = Rigid();
  ApplyNumbers(x, a);
  EXPECT_FALSE(a.two_inertia);
  EXPECT_EQ(a.motor_inertia, 6e-5);
}

TEST(ApplyNumbers, DelayAndLagAddUp) {
  ExtensionsConfig x;
  x.input_delay.emplace();
  x.input_delay->delay_us = 150.0;
  x.current_lag.emplace();
  x.current_lag->time_constant_us = 30.0;
  StatedAxis a = Rigid();
  ApplyNumbers(x, a);
  EXPECT_NEAR(a.delay_s, 1.15e-3, 1e-15);
  EXPECT_NEAR(a.lag_s, 2.3e-4, 1e-15);
}

TEST(ApplyExtras, ForcesAreInUnitsOfTheTorqueThatIsAskedFor) {
  ExtensionsConfig x;
  x.torque_constant.emplace();
  x.torque_constant->ratio = 0.8;
  x.constant_torque.emplace();
  x.constant_torque->torque_Nm = 0.02;
  x.cogging.emplace();
  x.cogging->amplitude_Nm = 0.01;
  x.cogging->order_per_rev = 12.0;
  x.cogging->phase_rad = 0.3;
  StatedAxis a = Rigid();
  ApplyExtras(x, a);
  EXPECT_NEAR(a.offset, 0.025, 1e-15);
  ASSERT_EQ(a.extras.cogging.size(), 1U);
  EXPECT_NEAR(a.extras.cogging[0].amplitude, 0.0125, 1e-15);
  EXPECT_EQ(a.extras.cogging[0].order_per_rev, 12.0);
  EXPECT_EQ(a.extras.cogging[0].phase_rad, 0.3);
}

TEST(ApplyExtras, TablesGoToMetres) {
  ExtensionsConfig x;
  x.pitch_error.emplace();
  x.pitch_error->position_mm = {-10.0, 20.0};
  x.pitch_error->error_um = {1.0, -3.0};
  StatedAxis a = Rigid();
  ApplyExtras(x, a);
  EXPECT_NEAR(a.extras.pitch_error_m.position_m[1], 0.02, 1e-15);
  EXPECT_NEAR(a.extras.pitch_error_m.value[1], -3e-6, 1e-18);
  // Straight between the points, constant beyond them.
  EXPECT_NEAR(ValueAt(a.extras.pitch_error_m.position_m, a.extras.pitch_error_m.value, 5e-3), -1e-6, 1e-18);
  EXPECT_NEAR(ValueAt(a.extras.pitch_error_m.position_m, a.extras.pitch_error_m.value, 1.0), -3e-6, 1e-18);
}

}  // namespace
}  // namespace contour::diagnosis
