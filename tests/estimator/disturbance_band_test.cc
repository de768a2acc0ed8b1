#include "estimator/disturbance_band.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

TEST(DisturbanceBand, BeforeAnyMotionItIsWhatFrictionMayBeOffBy) {
  const DisturbanceBand band(8.0, kPeriod_s);
  EXPECT_DOUBLE_EQ(band.Std_N(0.0), 8.0);
  EXPECT_DOUBLE_EQ(band.Std_N(36.0), 10.0);
}

TEST(DisturbanceBand, InMotionItIsWhatTheDisturbanceLatelyWas) {
  DisturbanceBand band(8.0, kPeriod_s);
  for (int k = 0; k < 4000; ++k) band.Step(k % 2 == 0 ? 3.0 : -3.0);
  EXPECT_NEAR(band.Std_N(0.0), 3.0, 0.01);
  for (int k = 0; k < 4000; ++k) band.Step(0.0);
  EXPECT_LT(band.Std_N(0.0), 0.1);
}

TEST(DisturbanceBand, ItsMemoryIsATimeAtEveryPeriod) {
  DisturbanceBand slow(8.0, 2e-3), fast(8.0, 0.5e-3);
  for (int k = 0; k < 1000; ++k) slow.Step(0.0);
  for (int k = 0; k < 4000; ++k) fast.Step(0.0);
  for (int k = 0; k < 100; ++k) slow.Step(5.0);
  for (int k = 0; k < 400; ++k) fast.Step(5.0);
  EXPECT_NEAR(slow.Std_N(0.0), fast.Std_N(0.0), 0.02);
  EXPECT_GT(slow.Std_N(0.0), 2.0);
}

TEST(DisturbanceBand, ResetForgets) {
  DisturbanceBand band(8.0, kPeriod_s);
  for (int k = 0; k < 100; ++k) band.Step(0.0);
  band.Reset();
  EXPECT_DOUBLE_EQ(band.Std_N(0.0), 8.0);
}

}  // namespace
}  // namespace contour
