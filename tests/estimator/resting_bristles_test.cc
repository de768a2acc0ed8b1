#include "estimator/resting_bristles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace contour {
namespace {

constexpr double kLevel_N = 45.0, kPeriod_s = 1e-3;

/// Bristles as believed, and what the axis needs in truth.
struct Rest {
  RestingBristles bristles{kLevel_N, 0.3, kPeriod_s};
  double carried_N = -40.0;
  double noise_takes_s = 0.0;

  void For(double time_s, double needed_N) {
    for (int i = 0; i < static_cast<int>(time_s / kPeriod_s); ++i)
      carried_N *= bristles.Step(carried_N, needed_N - carried_N, noise_takes_s);
  }
};

TEST(RestingBristles, ComeDownWithTheForceThatHoldsTheAxis) {
  Rest rest;
  for (int i = 0; i < 100; ++i) {
    const double needed_N = -40.0 * std::exp(-0.01 * i);
    rest.For(0.02, needed_N);
    EXPECT_NEAR(rest.carried_N, needed_N, 2.0);
  }
}

TEST(RestingBristles, NeverCarryMoreNorTheOtherWayRound) {
  Rest more;
  more.For(2.0, -55.0);
  EXPECT_NEAR(more.carried_N, -40.0, 1e-9);
  Rest other;
  for (int i = 0; i < 100; ++i) other.For(0.05, -40.0 + i);
  EXPECT_LE(other.carried_N, 0.0);
  EXPECT_GT(other.carried_N, -2.0);
  // And come back with it.
  for (int i = 100; i > 0; --i) other.For(0.05, -40.0 + i);
  EXPECT_NEAR(other.carried_N, -40.0, 2.0);
}

TEST(RestingBristles, OfASuddenForceMostIsFromOutside) {
  Rest rest;
  rest.For(1.0, -38.0);
  rest.For(2.0, 60.0 - 38.0);
  EXPECT_NEAR(rest.carried_N, -38.0 + 0.3 * kLevel_N, 0.5);
  rest.For(1.0, -38.0);
  EXPECT_NEAR(rest.carried_N, -38.0, 0.5);
}

// A drive that answers each count of its encoder reports torques that scatter by more than friction. What
// comes through moves the axis, since what is carried winds the screw up.
TEST(RestingBristles, AfterSecondsTheNoiseOfReportsHardlyMovesThem) {
  std::mt19937 random{1};
  std::normal_distribution<double> noise_N{0.0, kLevel_N};
  Rest rest;
  rest.noise_takes_s = 2.0;
  const auto swing_N = [&](double time_s) {
    double least_N = 0.0, most_N = -kLevel_N;
    for (int i = 0; i < static_cast<int>(time_s / kPeriod_s); ++i) {
      rest.For(kPeriod_s, -20.0 + std::clamp(noise_N(random), -0.3 * kLevel_N, 0.3 * kLevel_N));
      least_N = std::min(least_N, rest.carried_N);
      most_N = std::max(most_N, rest.carried_N);
    }
    return most_N - least_N;
  };
  rest.For(0.2, -20.0);
  const double first_N = swing_N(0.5);
  swing_N(4.0);
  EXPECT_LT(swing_N(3.0), 0.5 * first_N);
  EXPECT_NEAR(rest.carried_N, -20.0, 1.5);
}

TEST(RestingBristles, WhatIsHardlyThereTellsNothing) {
  Rest rest;
  rest.carried_N = 3.0;
  rest.For(1.0, 0.0);
  EXPECT_EQ(rest.carried_N, 3.0);
}

TEST(RestingBristles, ANewRestBeginsFromWhatTheyCarryThen) {
  Rest rest;
  rest.For(1.0, -28.0);
  rest.bristles.Move();
  rest.carried_N = -40.0;
  rest.For(1.0, -40.0);
  EXPECT_NEAR(rest.carried_N, -40.0, 1e-9);
}

}  // namespace
}  // namespace contour
