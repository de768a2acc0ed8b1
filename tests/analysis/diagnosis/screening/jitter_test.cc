#include "analysis/diagnosis/screening/jitter.h"

#include <gtest/gtest.h>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Long(std::vector<test::HiddenEffect> effects) {
  test::HiddenOptions o = test::FittedAxis::Short(std::move(effects));
  o.duration_s = 20.0;
  return o;
}

TEST(Jitter, OfTheInstantsIsFoundWithItsSize) {
  const test::FittedAxis axis(Long({{"sample_jitter", 14.0, 0.0, 0.0, 0.0}}));
  const Jitter jitter = TestJitter(axis.problem, axis.base);
  ASSERT_TRUE(jitter.tested);
  EXPECT_GT(jitter.drop, 50.0);
  EXPECT_NEAR(jitter.rms_s, 14e-6, 2e-6);
  EXPECT_LT(jitter.sigma_s, 0.2 * jitter.rms_s);
}

TEST(Jitter, IsNotFoundWhereReadingsAreInTime) {
  const test::FittedAxis axis(Long({}));
  const Jitter jitter = TestJitter(axis.problem, axis.base);
  ASSERT_TRUE(jitter.tested);
  EXPECT_LT(jitter.drop, 20.0);
  EXPECT_LT(jitter.rms_s, 5e-6);
}

TEST(Jitter, WhatRoundingMayDoIsNone) {
  test::FittedAxis axis(Long({{"sample_jitter", 14.0, 0.0, 0.0, 0.0}}));
  const double fastest = axis.problem.signals->max_speed;
  axis.made.axis.stated.position_step = 14e-6 * fastest;
  EXPECT_GT(TestJitter(axis.problem, axis.base).drop, 50.0);
  axis.made.axis.stated.position_step = 6.0 * 14e-6 * fastest;
  EXPECT_EQ(TestJitter(axis.problem, axis.base).drop, 0.0);
}

TEST(Jitter, OneSpeedAloneCannotTell) {
  const test::FittedAxis axis(Long({}));
  axis.problem.signals->velocity.assign(axis.problem.rows(), 30.0);
  EXPECT_FALSE(TestJitter(axis.problem, axis.base).tested);
  // Rest neither: quantisation is no noise.
  axis.problem.signals->velocity.assign(axis.problem.rows(), 0.0);
  EXPECT_FALSE(TestJitter(axis.problem, axis.base).tested);
}

}  // namespace
}  // namespace contour::diagnosis
