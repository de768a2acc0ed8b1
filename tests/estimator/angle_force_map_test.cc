#include "estimator/angle_force_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

constexpr double kLead_m = 5e-3;
constexpr double kTurn = 6.283185307179586;

double Cogging_N(double position_m) { return 12.0 * std::sin(12.0 * kTurn * position_m / kLead_m + 1.0); }

/// So many turns at a speed under a force that goes with the angle and one that does not.
double Slide(AngleForceMap& map, double position_m, double turns, double velocity_m_s,
             double period_s = 1e-3) {
  const double step_m = velocity_m_s * period_s;
  const auto steps = static_cast<int>(turns * kLead_m / std::abs(step_m));
  for (int k = 0; k < steps; ++k) {
    const double missing_N = Cogging_N(position_m) - map.At_N(position_m, velocity_m_s);
    map.Learn(position_m, velocity_m_s, 0.0, missing_N + 7.0);
    position_m += step_m;
  }
  return position_m;
}

double LargestError_N(const AngleForceMap& map, double velocity_m_s) {
  double largest = 0.0;
  for (double p = 0.0; p < kLead_m; p += 1e-6)
    largest = std::max(largest, std::abs(Cogging_N(p) - map.At_N(p, velocity_m_s)));
  return largest;
}

TEST(AngleForceMap, AFewTurnsAreEnoughInEitherDirection) {
  AngleForceMap map({kLead_m, 0.5, 0.05});
  const double there = Slide(map, 0.1, 2.0, 0.017);
  EXPECT_LT(LargestError_N(map, 0.017), 8.0);
  Slide(map, there, 6.0, -0.05);
  EXPECT_LT(LargestError_N(map, -0.05), 4.0);
  EXPECT_LT(LargestError_N(map, 0.001), 4.0);  // used when it is too slow to learn, too
}

// As much is learnt in a turn of short cycles as in one of long ones.
TEST(AngleForceMap, LearnsBySecondsNotByCycles) {
  // Share of the cogging that is known, for an encoder whose noise averages out as fast.
  const auto learnt = [](double period_s) {
    AngleForceMap map({kLead_m, 15.0 * std::sqrt(1e-3 / period_s), 0.05, period_s});
    Slide(map, 0.1, 4.0, 0.017, period_s);
    double product = 0.0, square = 0.0;
    for (double p = 0.0; p < kLead_m; p += 1e-6) {
      product += Cogging_N(p) * map.At_N(p, 0.017);
      square += Cogging_N(p) * Cogging_N(p);
    }
    return product / square;
  };
  const double usual = learnt(1e-3);
  EXPECT_GT(usual, 0.2);
  EXPECT_LT(usual, 0.8);  // on the way, not there
  EXPECT_NEAR(learnt(0.5e-3), usual, 0.1 * usual);
}

TEST(AngleForceMap, FadesWhereACycleIsTooLong) {
  AngleForceMap map({kLead_m, 0.5, 0.05});
  Slide(map, 0.1, 4.0, 0.03);
  const double peak_m = 0.1 + kLead_m / 48.0;
  EXPECT_NE(map.At_N(peak_m, 0.03), 0.0);
  EXPECT_EQ(map.At_N(peak_m, 0.16), 0.0);
}

TEST(AngleForceMap, ACoarseEncoderTakesMoreVisits) {
  AngleForceMap fine({kLead_m, 0.5, 0.05}), coarse({kLead_m, 30.0, 0.05});
  Slide(fine, 0.1, 4.0, 0.017);
  Slide(coarse, 0.1, 4.0, 0.017);
  EXPECT_GT(LargestError_N(coarse, 0.017), 1.5 * LargestError_N(fine, 0.017));
}

TEST(AngleForceMap, AQuarterOfATurnToAndFroIsNoTurn) {
  AngleForceMap map({kLead_m, 0.5, 0.05});
  double position_m = 0.1, velocity_m_s = 0.017;
  for (int pass = 0; pass < 40; ++pass, velocity_m_s = -velocity_m_s)
    position_m = Slide(map, position_m, 0.25, velocity_m_s);
  EXPECT_FALSE(map.in_use());
  Slide(map, position_m, 2.0, 0.017);
  EXPECT_TRUE(map.in_use());
}

// Ten times the axis, ten times its forces, five times its lead: the same map.
TEST(AngleForceMap, GoesByTheAxisOwnFrictionLeadAndMass) {
  AngleForceMap::Tuning large;
  large.lead_m = 5.0 * kLead_m;
  large.noise_N = 5.0;
  large.rate = 0.05;
  large.level_N = 400.0;
  large.vs_m_s = 10e-3;
  large.mass_kg = 180.0;
  AngleForceMap small({kLead_m, 0.5, 0.05}), scaled(large);
  for (const double velocity_m_s : {0.017, 0.002, 0.1}) {
    double position_m = 0.1;
    for (int k = 0; k < 2000; ++k) {
      const double acceleration_m_s2 = k % 3 == 0 ? 1.5 : 0.5;
      const double missing_N = Cogging_N(position_m) - small.At_N(position_m, velocity_m_s);
      small.Learn(position_m, velocity_m_s, acceleration_m_s2, missing_N);
      scaled.Learn(5.0 * position_m, 5.0 * velocity_m_s, 5.0 * acceleration_m_s2, 10.0 * missing_N);
      position_m += velocity_m_s * 1e-3;
    }
  }
  EXPECT_TRUE(small.in_use());
  for (double p = 0.0; p < kLead_m; p += 1e-4)
    EXPECT_NEAR(scaled.At_N(5.0 * p, 0.05), 10.0 * small.At_N(p, 0.01), 1e-6);
}

TEST(AngleForceMap, WhatDoesNotComeBackIsNotUsed) {
  AngleForceMap map({kLead_m, 0.5, 0.05});
  unsigned random = 1;
  for (int k = 0; k < 5000; ++k) {
    random = random * 1664525u + 1013904223u;
    const double noise_N = 5.0 * (random / 2147483648.0 - 1.0);
    map.Learn(2e-5 * k, 0.02, 0.0, noise_N - map.At_N(2e-5 * k, 0.02));
  }
  for (double p = 0.0; p < kLead_m; p += 1e-5) EXPECT_EQ(map.At_N(p, 0.02), 0.0);
}

TEST(AngleForceMap, NothingIsLearntNearRestNorWhenItIsSwitchedOff) {
  AngleForceMap slow({kLead_m, 0.5, 0.05}), off({kLead_m, 0.5, 0.0});
  Slide(slow, 0.1, 0.1, 0.002);
  Slide(off, 0.1, 1.0, 0.03);
  for (double p = 0.0; p < kLead_m; p += 1e-5) {
    EXPECT_EQ(slow.At_N(p, 0.0), 0.0);
    EXPECT_EQ(off.At_N(p, 0.0), 0.0);
  }
}

}  // namespace
}  // namespace contour
