#include "drivers/cia402/torque_rounding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace contour {
namespace {

constexpr TorqueScale kScale{0.637};
constexpr double kStep_Nm = 0.637e-3;
constexpr double kLimit_Nm = 1.5;

TEST(TorqueRounding, InMotionTheSumOfWhatWasSentIsRight) {
  TorqueRounding rounding;
  double wanted_Nm = 0.0, sent_Nm = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double torque = 2.3 * kStep_Nm * std::sin(1e-3 * k) + 0.05 * kStep_Nm;
    wanted_Nm += torque;
    sent_Nm += kScale.FromPerMille(rounding.Round(kScale, torque, kLimit_Nm, true));
    ASSERT_LE(std::abs(wanted_Nm - sent_Nm), 0.5001 * kStep_Nm) << k;
  }
}

TEST(TorqueRounding, ADemandBelowHalfAStepIsNotLost) {
  TorqueRounding rounding;
  int sum = 0;
  for (int k = 0; k < 1000; ++k) sum += rounding.Round(kScale, 0.3 * kStep_Nm, kLimit_Nm, true);
  EXPECT_NEAR(sum, 300, 1);
}

TEST(TorqueRounding, AtRestItIsStill) {
  TorqueRounding rounding;
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(rounding.Round(kScale, 0.3 * kStep_Nm, kLimit_Nm, false), 0);
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(rounding.Round(kScale, -7.6 * kStep_Nm, kLimit_Nm, false), -8);
}

TEST(TorqueRounding, NothingIsOwedFromBeforeARest) {
  TorqueRounding rounding;
  EXPECT_EQ(rounding.Round(kScale, 0.45 * kStep_Nm, kLimit_Nm, true), 0);
  EXPECT_EQ(rounding.Round(kScale, 0.0, kLimit_Nm, false), 0);
  EXPECT_EQ(rounding.Round(kScale, 0.4 * kStep_Nm, kLimit_Nm, true), 0);
}

TEST(TorqueRounding, TheLimitIsNeverPassedAndNothingPilesUpBehindIt) {
  TorqueRounding rounding;
  const std::int16_t most = kScale.ToPerMille(kLimit_Nm);
  for (int k = 0; k < 1000; ++k) {
    ASSERT_LE(rounding.Round(kScale, 10.0, kLimit_Nm, true), most);
    ASSERT_GT(rounding.Round(kScale, kLimit_Nm, kLimit_Nm, true), most - 2);
  }
  EXPECT_LE(rounding.Round(kScale, 0.0, kLimit_Nm, true), 1);
  for (int k = 0; k < 1000; ++k) ASSERT_GE(rounding.Round(kScale, -10.0, kLimit_Nm, true), -most);
  EXPECT_GE(rounding.Round(kScale, 0.0, kLimit_Nm, true), -1);
}

TEST(TorqueRounding, WhatIsNoNumberIsNoTorqueAndIsForgotten) {
  TorqueRounding rounding;
  EXPECT_EQ(rounding.Round(kScale, std::numeric_limits<double>::quiet_NaN(), kLimit_Nm, true), 0);
  EXPECT_EQ(rounding.Round(kScale, 3.0 * kStep_Nm, kLimit_Nm, true), 3);
}

}  // namespace
}  // namespace contour
