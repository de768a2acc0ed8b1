#include "control/screw_swing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/control/motion_rig.h"

namespace contour {
namespace {

/// The table nearly twice the motor.
MonitoredAxis HeavyTable() {
  MonitoredAxis axis = Axis();
  axis.motor_mass_kg = 177.0;
  axis.table_mass_kg = 309.0;
  axis.stiffness_N_m = 70e6;
  return axis;
}

struct Swung {
  double low_N = 0.0;  ///< largest that the low-pass leaves
  double bound_N = 0.0;
  double least_share = HUGE_VAL;  ///< of the bound over what is left, once it has come up
};

/// A force of 1000 N at `hz` that nothing explains, stirred by a torque of `torque_N`.
Swung Swing(double hz, double torque_N) {
  const MotionThresholds t = ThresholdsOf(HeavyTable(), {}, kPeriod_s);
  ScrewSwing swing;
  Swung all;
  double low_N = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double turned_rad = 2.0 * std::numbers::pi * hz * kPeriod_s * k;
    const double missing_N = 1000.0 * std::sin(turned_rad);
    low_N += t.filter * (missing_N - low_N);
    swing.See(missing_N - low_N, torque_N * std::cos(turned_rad), t);
    if (k < 200) continue;
    all.low_N = std::max(all.low_N, std::abs(low_N));
    all.bound_N = std::max(all.bound_N, swing.Left_N(t));
    all.least_share = std::min(all.least_share, swing.Left_N(t) / std::max(std::abs(low_N), 1e-9));
  }
  return all;
}

double Mode_Hz() {
  const MonitoredAxis a = HeavyTable();
  const double reduced_kg = a.motor_mass_kg * a.table_mass_kg / (a.motor_mass_kg + a.table_mass_kg);
  return std::sqrt(a.stiffness_N_m / reduced_kg) / (2.0 * std::numbers::pi);
}

TEST(ScrewSwing, LeavesNoMoreInTheFilteredForceThanItSays) {
  for (const double share : {0.7, 0.8, 1.0, 1.3, 2.0}) {
    const Swung all = Swing(share * Mode_Hz(), 1000.0);
    EXPECT_GT(all.least_share, 0.99) << share << " of the mode, " << all.low_N << " N";
    EXPECT_LT(all.bound_N, 4.0 * all.low_N) << share << " of the mode: the bound says nothing";
  }
}

TEST(ScrewSwing, WhatNoTorqueStirsIsNone) {
  EXPECT_EQ(Swing(Mode_Hz(), 0.0).bound_N, 0.0);
  const MotionThresholds t = ThresholdsOf(HeavyTable(), {}, kPeriod_s);
  EXPECT_LT(Swing(Mode_Hz(), 1.0).bound_N, 1.1 * t.swing_gain * t.swing_left);
}

TEST(ScrewSwing, ATableThatIsLightHardlySwingsItsMotor) {
  MonitoredAxis light = HeavyTable();
  light.table_mass_kg = 0.1 * light.motor_mass_kg;
  EXPECT_LT(ThresholdsOf(light, {}, kPeriod_s).swing_gain,
            0.1 * ThresholdsOf(HeavyTable(), {}, kPeriod_s).swing_gain);
}

TEST(ScrewSwing, ASteadyForceIsNoSwing) {
  const MotionThresholds t = ThresholdsOf(HeavyTable(), {}, kPeriod_s);
  ScrewSwing swing;
  double low_N = 0.0;
  for (int k = 0; k < 400; ++k) {
    low_N += t.filter * (2000.0 - low_N);
    swing.See(2000.0 - low_N, 500.0, t);
  }
  EXPECT_LT(swing.Left_N(t), 1.0);
}

TEST(ScrewSwing, BeginsAnewWithTheAxis) {
  const MotionThresholds t = ThresholdsOf(HeavyTable(), {}, kPeriod_s);
  ScrewSwing swing;
  for (int k = 0; k < 100; ++k) swing.See(k % 2 == 0 ? 1000.0 : -1000.0, 1000.0, t);
  EXPECT_GT(swing.Left_N(t), 100.0);
  swing.Restart();
  EXPECT_EQ(swing.Left_N(t), 0.0);
}

}  // namespace
}  // namespace contour
