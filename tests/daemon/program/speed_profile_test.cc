#include "daemon/program/speed_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace contour {
namespace {

const RampLimits kLimits{5.0, 200.0, 0.0};

struct Case {
  double length_m, in_m_s, cruise_m_s, out_m_s;
};

const std::vector<Case> kCases = {{0.05, 0.0, 0.05, 0.0},  {0.05, 0.02, 0.1, 0.0}, {0.001, 0.0, 0.1, 0.0},
                                  {0.01, 0.01, 0.2, 0.02}, {1e-6, 0.0, 0.1, 0.0},  {0.02, 0.05, 0.05, 0.05}};

TEST(SpeedProfile, StaysWithinItsLimitsAndCoversItsLength) {
  for (const Case& c : kCases) {
    const SpeedProfile profile(c.length_m, c.in_m_s, c.cruise_m_s, c.out_m_s, kLimits);
    constexpr int kSteps = 20000;
    const double step = profile.duration_s() / kSteps;
    double way = 0.0;
    double previous_acceleration = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const AlongCurve a = profile.At(i * step);
      way += profile.At((i + 0.5) * step).speed_m_s * step;
      EXPECT_LE(a.speed_m_s, c.cruise_m_s * (1.0 + 1e-12));
      EXPECT_GE(a.speed_m_s, 0.0);
      EXPECT_LE(std::abs(a.acceleration_m_s2), 5.0 * (1.0 + 1e-9));
      EXPECT_LE(std::abs(a.acceleration_m_s2 - previous_acceleration), 200.0 * step * (1.0 + 1e-6));
      previous_acceleration = a.acceleration_m_s2;
    }
    EXPECT_NEAR(way, c.length_m, 1e-7 * c.length_m + 1e-12);
    EXPECT_EQ(profile.At(0.0).speed_m_s, c.in_m_s);
    EXPECT_EQ(profile.At(profile.duration_s()).speed_m_s, c.out_m_s);
    EXPECT_EQ(profile.At(profile.duration_s()).s_m, c.length_m);
  }
}

TEST(SpeedProfile, SpeedAndAccelerationAreDerivatives) {
  for (const Case& c : kCases) {
    const SpeedProfile profile(c.length_m, c.in_m_s, c.cruise_m_s, c.out_m_s, kLimits);
    const double h = profile.duration_s() * 1e-5;
    for (double t = h; t < profile.duration_s() - h; t += profile.duration_s() / 113.0) {
      const AlongCurve before = profile.At(t - h);
      const AlongCurve at = profile.At(t);
      const AlongCurve after = profile.At(t + h);
      EXPECT_NEAR(at.speed_m_s, (after.s_m - before.s_m) / (2 * h), 1e-6);
      EXPECT_NEAR(at.acceleration_m_s2, (after.speed_m_s - before.speed_m_s) / (2 * h), 1e-3);
    }
  }
}

TEST(SpeedProfile, OneOfTheLimitsIsUsedInFull) {
  // 6 dv / j against (1.5 dv / a)^2: a small change is limited by jerk, a large one by acceleration.
  EXPECT_DOUBLE_EQ(RampTime_s(0.0, 0.01, kLimits), std::sqrt(6.0 * 0.01 / 200.0));
  EXPECT_DOUBLE_EQ(RampTime_s(1.0, 0.0, kLimits), 1.5 * 1.0 / 5.0);
  EXPECT_DOUBLE_EQ(RampTime_s(0.0, 0.01, {5.0, 0.0, 0.0}), 1.5 * 0.01 / 5.0);
  EXPECT_DOUBLE_EQ(RampTime_s(0.0, 0.01, {5.0, 200.0, 0.2}), 0.2);
  EXPECT_EQ(RampTime_s(0.3, 0.3, kLimits), 0.0);
}

TEST(SpeedProfile, ReachableSpeedUsesTheWholeLength) {
  const double reached = ReachableSpeed_m_s(0.01, 0.002, 1.0, kLimits);
  EXPECT_GT(reached, 0.01);
  EXPECT_NEAR(RampLength_m(0.01, reached, kLimits), 0.002, 1e-12);
  EXPECT_EQ(ReachableSpeed_m_s(0.01, 1.0, 0.05, kLimits), 0.05);
}

}  // namespace
}  // namespace contour
