#include "estimator/resting_window.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3, kLoud_s = 5.0, kShare = 0.02;

double After(RestingWindow& window, double time_s, double noise_takes_s = kLoud_s) {
  double last = 0.0;
  for (int i = 0; i < static_cast<int>(time_s / kPeriod_s); ++i) last = window.Rest(kShare, noise_takes_s);
  return last;
}

TEST(RestingWindow, AShortRestIsAveragedAsEver) {
  RestingWindow window(kPeriod_s);
  EXPECT_EQ(After(window, 0.39), kShare);
}

TEST(RestingWindow, GrowsWithTheRestAsFarAsASecond) {
  RestingWindow window(kPeriod_s);
  EXPECT_NEAR(After(window, 4.0), kPeriod_s / 0.5, 1e-9);
  EXPECT_NEAR(After(window, 4.0), kPeriod_s, 1e-9);
  EXPECT_NEAR(After(window, 100.0), kPeriod_s, 1e-12);
}

TEST(RestingWindow, IsNoLongerThanTheNoiseTakesIt) {
  RestingWindow window(kPeriod_s);
  EXPECT_NEAR(After(window, 6.0, 0.2), kPeriod_s / 0.2, 1e-9);
  EXPECT_EQ(After(window, 0.1, 0.03), kShare);
  EXPECT_EQ(After(window, 0.1, 0.0), kShare);
}

TEST(RestingWindow, IsOfTimeNotOfCycles) {
  RestingWindow slow(4.0 * kPeriod_s);
  double last = 0.0;
  for (int i = 0; i < 1000; ++i) last = slow.Rest(0.08, kLoud_s);
  EXPECT_NEAR(last, 4.0 * kPeriod_s / 0.5, 1e-9);
}

TEST(RestingWindow, MotionEndsARest) {
  RestingWindow window(kPeriod_s);
  EXPECT_LT(After(window, 6.0), 0.002);
  window.Move();
  EXPECT_EQ(After(window, 0.2), kShare);
}

}  // namespace
}  // namespace contour
