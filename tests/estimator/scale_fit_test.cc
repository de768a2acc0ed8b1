#include "estimator/scale_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kTurn_m = 5e-3;
constexpr double kStiffness_N_m = 40e6;

ScaleFit::Setup TheSetup() {
  return {kPeriod_s, 1e-7, 0.15 / kStiffness_N_m, 25.0 / kStiffness_N_m, kTurn_m, true};
}

/// An axis that goes to and fro under friction of 40 N and by so much of an error.
struct Motion {
  double extra_m_N = 0.0, slope = 0.0, turn_m = 0.0, jump_m = 0.0, noise_m = 0.0, mass_kg = 0.0;
  [[nodiscard]] ScaleFit::Sample At(int k, std::mt19937& random) const {
    const double t = kPeriod_s * k;
    ScaleFit::Sample s;
    s.travel_m = 10e-3 * std::sin(2.0 * std::numbers::pi * t);
    s.force_N = 40.0 * std::tanh(20.0 * std::cos(2.0 * std::numbers::pi * t));
    const double angle = 2.0 * std::numbers::pi * s.travel_m / kTurn_m;
    s.cos = std::cos(angle);
    s.sin = std::sin(angle);
    s.acceleration_m_s2 = -0.4 * std::sin(2.0 * std::numbers::pi * t);
    s.moves = true;
    std::normal_distribution<double> noise(0.0, noise_m);
    s.apart_m = jump_m + extra_m_N * s.force_N + slope * s.travel_m + turn_m * s.cos +
                mass_kg * s.acceleration_m_s2 / kStiffness_N_m + (noise_m > 0.0 ? noise(random) : 0.0);
    return s;
  }
};

TEST(ScaleFit, FindsStiffnessLeadAndZeroApart) {
  ScaleFit fit(TheSetup());
  fit.Reset(0.0);
  std::mt19937 random(1);
  const Motion motion{0.2 / kStiffness_N_m, 5e-5, 0.3e-6, 2e-6, 20e-9};
  fit.Reset(motion.jump_m);
  for (int k = 0; k < 5000; ++k) fit.Learn(motion.At(k, random));
  EXPECT_NEAR(fit.extra_compliance_m_N(), motion.extra_m_N, 0.02 / kStiffness_N_m);
  EXPECT_LT(std::abs(fit.extra_compliance_m_N() - motion.extra_m_N), 2.0 * fit.compliance_std_m_N());
  EXPECT_LT(fit.compliance_std_m_N(), 0.05 / kStiffness_N_m);
  EXPECT_NEAR(fit.zero_m(), motion.jump_m, 0.05e-6);
  EXPECT_NEAR(fit.Lead_m(0.0, 0.0), motion.turn_m, 0.05e-6);
  EXPECT_NEAR(fit.Lead_m(5e-3, 0.0) - fit.Lead_m(0.0, 0.0), 5e-3 * motion.slope, 0.05e-6);
}

TEST(ScaleFit, IsNearTheStiffnessAfterOneSecondAlready) {
  ScaleFit fit(TheSetup());
  fit.Reset(0.0);
  std::mt19937 random(1);
  const Motion motion{.extra_m_N = 0.2 / kStiffness_N_m, .noise_m = 20e-9};
  for (int k = 0; k < 1500; ++k) fit.Learn(motion.At(k, random));
  EXPECT_NEAR(fit.extra_compliance_m_N(), motion.extra_m_N, 0.04 / kStiffness_N_m);
}

// The force through the screw is torque less what accelerates the motor, whose mass may be off.
TEST(ScaleFit, AMotorHeavierThanStatedIsNotTakenForASofterScrew) {
  ScaleFit fit(TheSetup());
  fit.Reset(0.0);
  std::mt19937 random(1);
  const Motion motion{.extra_m_N = 0.2 / kStiffness_N_m, .noise_m = 20e-9, .mass_kg = 60.0};
  for (int k = 0; k < 5000; ++k) fit.Learn(motion.At(k, random));
  EXPECT_NEAR(fit.extra_compliance_m_N(), motion.extra_m_N, 0.03 / kStiffness_N_m);
}

// Corners tell it from the lead, which follows the travel.
TEST(ScaleFit, CornersTellTheMotorsMass) {
  constexpr double kLighter_kg = 24.0;
  ScaleFit fit(TheSetup());
  fit.Reset(0.0);
  std::mt19937 random(1);
  const Motion motion{.extra_m_N = 0.2 / kStiffness_N_m, .slope = 5e-5, .noise_m = 20e-9};
  for (int k = 0; k < 2000; ++k) {
    ScaleFit::Sample s = motion.At(k, random);
    const double corner_m_s2 = k / 250 % 2 == 0 ? 2.0 : -2.0;
    s.acceleration_m_s2 = k % 250 < 20 ? corner_m_s2 : 0.0;
    s.apart_m += kLighter_kg * s.acceleration_m_s2 / kStiffness_N_m;
    fit.Learn(s);
  }
  const double known_s2 = fit.motor_extra_s2();
  EXPECT_NEAR(kStiffness_N_m * known_s2, -kLighter_kg, 0.1 * kLighter_kg);
  // An axis that was let go has the motor that it had.
  fit.LetGo(1e-6);
  EXPECT_EQ(fit.motor_extra_s2(), known_s2);
  EXPECT_EQ(fit.extra_compliance_m_N(), 0.0);
  EXPECT_EQ(fit.zero_m(), 1e-6);
  fit.Reset(0.0);
  EXPECT_EQ(fit.motor_extra_s2(), 0.0);
}

// A minute of rest with a zero that creeps, as of a screw that cools.
TEST(ScaleFit, AtRestOnlyTheZeroIsLearnt) {
  ScaleFit fit(TheSetup());
  fit.Reset(0.0);
  for (int k = 0; k < 60000; ++k) {
    ScaleFit::Sample s;
    s.apart_m = 3e-6 * k / 60000.0;
    s.force_N = 30.0;
    s.cos = 1.0;
    fit.Learn(s);
  }
  EXPECT_NEAR(fit.zero_m(), 3e-6, 0.1e-6);
  EXPECT_EQ(fit.extra_compliance_m_N(), 0.0);
  EXPECT_EQ(fit.Lead_m(1e-3, 1e-3), 0.0);
}

/// A scale that counts in steps tells of a stiff screw; the fit after so many periods of motion.
ScaleFit AfterCountsOf(double count_m, int periods, unsigned seed) {
  ScaleFit::Setup setup = TheSetup();
  setup.count_m = count_m;
  ScaleFit fit(setup);
  fit.Reset(0.0);
  std::mt19937 random(seed);
  const Motion motion{.extra_m_N = 0.2 / kStiffness_N_m, .noise_m = 20e-9};
  const double where_m = count_m * std::uniform_real_distribution<double>(0.0, 1.0)(random);
  double before_m = 0.0;
  for (int k = 0; k < periods; ++k) {
    ScaleFit::Sample s = motion.At(k, random);
    const double table_m = s.travel_m - s.apart_m + where_m;
    s.velocity_m_s = (s.travel_m - before_m) / kPeriod_s;
    s.apart_m += table_m - count_m * std::round(table_m / count_m);
    before_m = s.travel_m;
    fit.Learn(s);
  }
  return fit;
}

// Before: rounding counted as nothing, and 5 um made the screw as stiff or soft as bounds allow within 2 %.
TEST(ScaleFit, RoundingOfACoarseScaleIsNoStiffness) {
  for (const double count_m : {1e-6, 5e-6, 20e-6})
    for (const unsigned seed : {1U, 2U, 3U, 4U})
      for (const int periods : {100, 300, 1000, 8000}) {
        const ScaleFit fit = AfterCountsOf(count_m, periods, seed);
        EXPECT_LT(std::abs(fit.extra_compliance_m_N() - 0.2 / kStiffness_N_m), 3.0 * fit.compliance_std_m_N())
            << count_m << ' ' << seed << ' ' << periods;
        // Nor is it a lead: what the target is moved by beyond the scale's zero stays below a count.
        EXPECT_LT(std::abs(fit.Lead_m(10e-3, 10e-3)), 0.75 * count_m + 0.75e-6)
            << count_m << ' ' << seed << ' ' << periods;
      }
}

TEST(ScaleFit, AtRestACountTellsNoMoreThanWhereItLies) {
  ScaleFit::Setup setup = TheSetup();
  setup.count_m = 5e-6;
  ScaleFit fit(setup);
  fit.Reset(0.0);
  ScaleFit::Sample s;
  s.apart_m = 4.9e-6;
  for (int k = 0; k < 5000; ++k) fit.Learn(s);
  EXPECT_EQ(fit.zero_m(), 0.0);
  s.apart_m = 6.5e-6;
  for (int k = 0; k < 5000; ++k) fit.Learn(s);
  EXPECT_NEAR(fit.zero_m(), 1.5e-6, 1e-9);
}

// Before: the bound held the lead back and the zero that went with it ran on, 82 mm in six seconds.
TEST(ScaleFit, ALeadBeyondItsBoundDoesNotTakeTheZeroAlong) {
  constexpr double kTurnError_m = 20e-6, kSlow_m_s = 1e-3;
  const double w = std::numbers::pi;
  ScaleFit fit(TheSetup());
  fit.Reset(0.0);
  double before_m = 0.0;
  for (int k = 0; k < 6000; ++k) {
    const double t = kPeriod_s * k;
    ScaleFit::Sample s;
    s.moves = true;
    // It starts as programs do: a while of little motion, in which lead and zero are hardly apart.
    s.travel_m = 10e-3 * std::min(1.0, t) * std::sin(w * t);
    s.velocity_m_s = (s.travel_m - before_m) / kPeriod_s;
    before_m = s.travel_m;
    s.force_N = 40.0 * std::tanh(s.velocity_m_s / kSlow_m_s);
    const double angle = 2.0 * std::numbers::pi * s.travel_m / kTurn_m;
    s.cos = std::cos(angle);
    s.sin = std::sin(angle);
    s.apart_m = kTurnError_m * s.cos;
    fit.Learn(s);
    ASSERT_LT(std::abs(fit.zero_m()), 1.1 * kTurnError_m) << k;
  }
}

TEST(ScaleFit, StaysWithinBoundsWhateverItIsTold) {
  ScaleFit fit(TheSetup());
  fit.Reset(0.0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> wild(-1.0, 1.0);
  for (int k = 0; k < 20000; ++k) {
    ScaleFit::Sample s;
    s.apart_m = 1e-3 * wild(random);
    s.force_N = 2000.0 * wild(random);
    s.travel_m = 0.2 * wild(random);
    s.cos = wild(random);
    s.sin = wild(random);
    s.moves = true;
    fit.Learn(s);
    ASSERT_LE(std::abs(fit.extra_compliance_m_N()), 4.01 * 0.15 / kStiffness_N_m);
    ASSERT_TRUE(std::isfinite(fit.zero_m()));
  }
}

TEST(ScaleFit, WithoutLearningItKeepsWhatWasCommissioned) {
  ScaleFit::Setup setup = TheSetup();
  setup.learns = false;
  ScaleFit fit(setup);
  fit.Reset(0.0);
  std::mt19937 random(1);
  const Motion motion{.extra_m_N = 0.2 / kStiffness_N_m};
  for (int k = 0; k < 3000; ++k) fit.Learn(motion.At(k, random));
  EXPECT_EQ(fit.extra_compliance_m_N(), 0.0);
}

}  // namespace
}  // namespace contour
