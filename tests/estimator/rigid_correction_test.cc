#include "estimator/rigid_correction.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

constexpr RigidCorrection::Tuning kTuning{90.0, 500.0, 0.001, 0.001};

TEST(RigidCorrection, TellsInertiaFromViscousFriction) {
  RigidCorrection rigid(kTuning);
  for (int k = 0; k < 30000; ++k) {
    const double v = 0.05 * std::sin(0.005 * k), a = 0.25 * std::cos(0.005 * k);
    rigid.Learn((6.0 - rigid.extra_kg()) * a + (-80.0 - rigid.extra_Ns_m()) * v, v, a);
  }
  EXPECT_NEAR(rigid.extra_kg(), 6.0, 0.1);
  EXPECT_NEAR(rigid.extra_Ns_m(), -80.0, 2.0);
}

TEST(RigidCorrection, WhatOnlyChangesSignWithTheDirectionIsNotInertia) {
  RigidCorrection rigid({90.0, 500.0, 0.001, 0.0});
  for (int k = 0; k < 30000; ++k) {
    const double v = 0.05 * std::sin(0.005 * k), a = 0.25 * std::cos(0.005 * k);
    rigid.Learn((6.0 - rigid.extra_kg()) * a + (v > 0.0 ? 0.5 : -0.5), v, a);
  }
  EXPECT_NEAR(rigid.extra_kg(), 6.0, 0.5);
}

TEST(RigidCorrection, IsBounded) {
  RigidCorrection rigid({90.0, 500.0, 0.1, 0.1});
  for (int k = 0; k < 10000; ++k) rigid.Learn(1e3, 0.1, 1.0);
  EXPECT_DOUBLE_EQ(rigid.extra_kg(), 36.0);
  EXPECT_DOUBLE_EQ(rigid.extra_Ns_m(), 1100.0);
  for (int k = 0; k < 10000; ++k) rigid.Learn(-1e3, 0.1, 1.0);
  EXPECT_DOUBLE_EQ(rigid.extra_kg(), -36.0);
  EXPECT_DOUBLE_EQ(rigid.extra_Ns_m(), -500.0);  // no viscous friction at all
}

TEST(RigidCorrection, WithoutALevelASlowMotionTeachesViscousFriction) {
  RigidCorrection none(kTuning), full(kTuning);
  for (int k = 0; k < 3000; ++k) {  // the circle of 100 um: 0.5 mm/s
    const double v = 0.5e-3 * std::sin(5e-3 * k), a = 2.5e-3 * std::cos(5e-3 * k);
    none.Learn((-500.0 - none.extra_Ns_m()) * v, v, a, 1e-4);
    // Half a newton of a wrong friction level would be a thousand Ns/m.
    full.Learn(v > 0.0 ? 0.5 : -0.5, v, a, 1.0);
  }
  EXPECT_NEAR(none.extra_Ns_m(), -500.0, 5.0);
  EXPECT_LT(std::abs(full.extra_Ns_m()), 10.0);
}

TEST(RigidCorrection, AtRestNothingIsLearnt) {
  RigidCorrection rigid(kTuning);
  for (int k = 0; k < 1000; ++k) rigid.Learn(10.0, 0.0, 0.0);
  EXPECT_EQ(rigid.extra_kg(), 0.0);
  EXPECT_EQ(rigid.extra_Ns_m(), 0.0);
}

}  // namespace
}  // namespace contour
