#include "estimator/viscous_correction.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

constexpr ViscousCorrection::Tuning kTuning{500.0, 0.001};

// A small force that is always there changes little about it.
TEST(ViscousCorrection, IsLearntFromWhatGoesWithTheVelocity) {
  for (const double constant_N : {0.0, 2.0}) {
    ViscousCorrection viscous(kTuning);
    for (int k = 0; k < 30000; ++k) {
      const double v = 0.05 * std::sin(0.005 * k), a = 0.25 * std::cos(0.005 * k);
      viscous.Learn(constant_N + (-80.0 - viscous.extra_Ns_m()) * v, v, a);
    }
    EXPECT_NEAR(viscous.extra_Ns_m(), -80.0, 15.0);
  }
}

// At one speed it cannot be told from Coulomb friction, of which the level takes care.
TEST(ViscousCorrection, OneSpeedTeachesNothing) {
  ViscousCorrection viscous(kTuning);
  for (int k = 0; k < 30000; ++k) {
    const double sign = k / 400 % 2 == 0 ? 1.0 : -1.0;
    viscous.Learn(5.0 * sign, 0.035 * sign, 0.0);
  }
  EXPECT_LT(std::abs(viscous.extra_Ns_m()), 20.0);
}

TEST(ViscousCorrection, IsBounded) {
  ViscousCorrection viscous({500.0, 0.1});
  const auto speed = [](int k) { return 0.1 + 0.05 * std::sin(0.01 * k); };
  for (int k = 0; k < 10000; ++k) viscous.Learn(1e6 * speed(k), speed(k), 1.0);
  EXPECT_DOUBLE_EQ(viscous.extra_Ns_m(), 1100.0);
  for (int k = 0; k < 10000; ++k) viscous.Learn(-1e6 * speed(k), speed(k), 1.0);
  EXPECT_DOUBLE_EQ(viscous.extra_Ns_m(), -500.0);  // no viscous friction at all
}

TEST(ViscousCorrection, WithoutALevelASlowMotionTeachesIt) {
  ViscousCorrection none(kTuning), full(kTuning);
  for (int k = 0; k < 3000; ++k) {  // the circle of 100 um: 0.5 mm/s
    const double v = 0.5e-3 * std::sin(5e-3 * k), a = 2.5e-3 * std::cos(5e-3 * k);
    none.Learn((-500.0 - none.extra_Ns_m()) * v, v, a, 1e-4);
    // Half a newton of a wrong friction level would be a thousand Ns/m.
    full.Learn(v > 0.0 ? 0.5 : -0.5, v, a, 1.0);
  }
  EXPECT_NEAR(none.extra_Ns_m(), -500.0, 5.0);
  EXPECT_LT(std::abs(full.extra_Ns_m()), 10.0);
}

// As much is learnt in a second of short cycles as in a second of long ones.
TEST(ViscousCorrection, LearnsBySecondsNotByCycles) {
  const auto after_s = [](double duration_s, double period_s) {
    ViscousCorrection viscous({500.0, 0.001, period_s});
    for (int k = 0; k < std::lround(duration_s / period_s); ++k) {
      const double t = period_s * k, v = 0.05 * std::sin(5.0 * t), a = 0.25 * std::cos(5.0 * t);
      viscous.Learn((-80.0 - viscous.extra_Ns_m()) * v, v, a);
    }
    return viscous.extra_Ns_m();
  };
  for (const double duration_s : {0.5, 2.0}) {
    const double usual = after_s(duration_s, 1e-3);
    EXPECT_LT(usual, -10.0);
    EXPECT_GT(usual, -75.0);  // on the way, not there
    EXPECT_NEAR(after_s(duration_s, 0.5e-3), usual, 0.03 * std::abs(usual));
    EXPECT_NEAR(after_s(duration_s, 2e-3), usual, 0.03 * std::abs(usual));
  }
}

TEST(ViscousCorrection, AtRestNothingIsLearnt) {
  ViscousCorrection viscous(kTuning);
  for (int k = 0; k < 1000; ++k) viscous.Learn(10.0, 0.0, 0.0);
  EXPECT_EQ(viscous.extra_Ns_m(), 0.0);
}

}  // namespace
}  // namespace contour
