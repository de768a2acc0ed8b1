#include "control/swing_ahead.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/control/motion_rig.h"

namespace contour {
namespace {

MotionThresholds Thresholds() { return ThresholdsOf(Axis(), {}, kPeriod_s); }

/// The mode with a table so many times as heavy as stated.
double Mode_rad_s(double times) {
  const MonitoredAxis a = Axis();
  const double table_kg = times * a.table_mass_kg;
  return std::sqrt(a.stiffness_N_m * (a.motor_mass_kg + table_kg) / (a.motor_mass_kg * table_kg));
}

// A loop whose table was loaded makes it swing more and more, by far more than its torque could.
TEST(SwingAhead, ASwingThatGrowsStaysNearWhatItWasHeadedFor) {
  const MotionThresholds t = Thresholds();
  for (const double times : {0.7, 1.0, 1.3, 3.0, 10.0, 100.0}) {
    SwingAhead swing;
    double size_m = 1e-9;
    for (int k = 0; k < 400; ++k) {
      size_m *= 1.02;
      const double off_m = size_m * std::sin(Mode_rad_s(times) * kPeriod_s * k + 0.3);
      // The first turn is not known as one.
      if (k > 50) {
        EXPECT_LT(swing.Beyond_m(off_m, t), 0.06 * size_m) << times << ' ' << k;
      }
      swing.See(off_m, t);
    }
  }
}

TEST(SwingAhead, AReadingThatJumpsOutOfQuietIsAsFarOffAsItIs) {
  const MotionThresholds t = Thresholds();
  for (const double jump_m : {1e-5, -1e-4, 0.2e-3}) {
    SwingAhead swing;
    for (int k = 0; k < 200; ++k) swing.See(1e-8 * std::sin(1.7 * k), t);
    EXPECT_NEAR(swing.Beyond_m(jump_m, t), std::abs(jump_m), 4e-8);
  }
}

// What a loop makes of a table that was loaded, and what the encoder's steps make of nothing.
TEST(SwingAhead, OnlyWhatComesBackFromAsFarSwings) {
  const MotionThresholds t = Thresholds();
  constexpr double kLeast_m = 1e-6;
  for (const double size_m : {1e-5, 5e-7}) {
    SwingAhead swing;
    for (int k = 0; k < 200; ++k) swing.See(size_m * std::sin(Mode_rad_s(3.0) * kPeriod_s * k), t);
    EXPECT_EQ(swing.Swings(kLeast_m), size_m > kLeast_m);
  }
  for (const double factor : {1.1, 2.0}) {
    SwingAhead swing;
    for (int k = 0; k < 200; ++k) swing.See(2e-6 * std::sin(1.7 * k), t);
    EXPECT_TRUE(swing.Swings(kLeast_m));
    for (double off_m = 1e-6; off_m < 1e-3; off_m *= factor) swing.See(off_m, t);
    EXPECT_FALSE(swing.Swings(kLeast_m)) << "it runs away to one side";
  }
}

// An encoder that is reversed makes its loop run away to one side.
TEST(SwingAhead, WhatRunsAwayToOneSideIsNoSwing) {
  const MotionThresholds t = Thresholds();
  for (const double factor : {1.1, 1.3, 2.0}) {
    SwingAhead swing;
    for (int k = 0; k < 200; ++k) swing.See(1e-8 * std::sin(1.7 * k), t);
    for (double off_m = 1e-8; off_m < 1e-3; off_m *= factor) {
      // As soon as the one before is four times what came back of the noise.
      if (off_m > 4e-8 * factor) {
        EXPECT_EQ(swing.Beyond_m(off_m, t), off_m) << factor;
      }
      swing.See(off_m, t);
    }
  }
}

}  // namespace
}  // namespace contour
