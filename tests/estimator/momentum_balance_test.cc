#include "estimator/momentum_balance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr MomentumBalance::Tuning kTuning{90.0, kPeriod_s, 0.001, 0.001};

/// A mass pushed by a force that acts `delay` periods late, and friction that turns round with the motion.
struct Axis {
  double mass_kg = 90.0;
  double delay = 0.0;
  double friction_N = 0.0;  ///< what really is there beyond what is expected
  double constant_N = 0.0;
  double noise_m = 2e-9;
  double position_m = 0.0;
  double velocity_m_s = 0.0;
  double before_N = 0.0;
  double period_s = kPeriod_s;
  std::uint32_t random = 1;

  double Step(double force_N) {
    const double acts_N = force_N + delay * (before_N - force_N);
    before_N = force_N;
    const double opposing_N = constant_N + (velocity_m_s >= 0.0 ? friction_N : -friction_N);
    const double a = (acts_N - opposing_N) / mass_kg;
    position_m += period_s * (velocity_m_s + 0.5 * period_s * a);
    velocity_m_s += period_s * a;
    random = random * 1664525u + 1013904223u;
    return position_m + noise_m * (random / 2147483648.0 - 1.0);
  }
};

/// Force of a circle, by default of 10 mm at 3 m/min.
void Circle(Axis& axis, MomentumBalance& balance, int periods, double omega_1_s = 5.0, double a_m_s2 = 0.25) {
  axis.velocity_m_s = 0.0;
  for (int k = 0; k < periods; ++k) {
    const double force_N = axis.mass_kg * a_m_s2 * std::cos(omega_1_s * kPeriod_s * k) + axis.constant_N;
    balance.Learn(axis.Step(force_N), force_N, 0.0);
  }
}

TEST(MomentumBalance, FindsTheMassOnACircle) {
  for (const double mass_kg : {63.0, 90.0, 117.0}) {
    Axis axis{.mass_kg = mass_kg};
    MomentumBalance balance(kTuning);
    Circle(axis, balance, 6000);
    EXPECT_NEAR(balance.extra_kg(), mass_kg - 90.0, 3.0);
    EXPECT_LT(balance.delay_periods(), 0.02);
  }
}

TEST(MomentumBalance, FrictionAndCuttingForceAreNoMass) {
  Axis axis{.friction_N = 5.0, .constant_N = 60.0};
  MomentumBalance balance(kTuning);
  Circle(axis, balance, 6000);
  EXPECT_NEAR(balance.extra_kg(), 0.0, 3.0);
}

TEST(MomentumBalance, OneStrongPulseIsEnough) {
  Axis axis{.mass_kg = 117.0};
  MomentumBalance balance(kTuning);
  for (int k = 0; k < 60; ++k) {
    const double force_N = k < 20 ? 900.0 : 0.0;
    balance.Learn(axis.Step(force_N), force_N, 0.0);
  }
  EXPECT_NEAR(balance.extra_kg(), 27.0, 3.0);
}

TEST(MomentumBalance, ARingingLoopTeachesTheDelay) {
  Axis axis{.delay = 0.8};
  MomentumBalance balance(kTuning);
  for (int k = 0; k < 2000; ++k) {  // 40 Hz
    const double force_N = 60.0 * std::sin(0.25 * k);
    balance.Learn(axis.Step(force_N), force_N, 0.0);
  }
  EXPECT_NEAR(balance.delay_periods(), 0.8, 0.1);
  EXPECT_NEAR(balance.extra_kg(), 0.0, 3.0);
}

// As much is learnt in a second of short cycles as in a second of long ones.
TEST(MomentumBalance, LearnsBySecondsNotByCycles) {
  const auto learnt = [](double period_s, double duration_s, double omega_1_s, double late_s) {
    Axis axis{.mass_kg = 117.0, .delay = late_s / period_s, .noise_m = 0.0};
    axis.period_s = period_s;
    MomentumBalance balance({90.0, period_s, 0.001, 0.001});
    for (int k = 0; k < std::lround(duration_s / period_s); ++k) {
      // Mean over the period.
      const double from = omega_1_s * period_s * k, to = omega_1_s * period_s * (k + 1);
      const double force_N = 60.0 * (std::cos(from) - std::cos(to)) / (to - from);
      balance.Learn(axis.Step(force_N), force_N, 0.0);
    }
    return std::pair{balance.extra_kg(), balance.delay_periods() * period_s};
  };
  const double slow_kg = learnt(1e-3, 0.3, 12.0, 0.0).first;
  EXPECT_GT(slow_kg, 3.0);
  EXPECT_LT(slow_kg, 24.0);  // on the way, not there
  EXPECT_NEAR(learnt(0.5e-3, 0.3, 12.0, 0.0).first, slow_kg, 0.05 * slow_kg);
  const double late_s = learnt(1e-3, 0.1, 250.0, 0.4e-3).second;
  EXPECT_GT(late_s, 0.05e-3);
  EXPECT_NEAR(learnt(0.5e-3, 0.1, 250.0, 0.4e-3).second, late_s, 0.1 * late_s);
}

TEST(MomentumBalance, IsBounded) {
  Axis axis{.mass_kg = 900.0};
  MomentumBalance balance(kTuning);
  Circle(axis, balance, 3000);
  EXPECT_DOUBLE_EQ(balance.extra_kg(), 36.0);
}

TEST(MomentumBalance, NothingIsLearntFromNoMotionOrAcrossAGap) {
  MomentumBalance balance(kTuning);
  for (int k = 0; k < 1000; ++k) balance.Learn(1e-3, 20.0, 0.0);
  EXPECT_EQ(balance.extra_kg(), 0.0);
  balance.Pause();
  for (int k = 0; k < 3; ++k) balance.Learn(0.5, 0.0, 0.0);
  EXPECT_EQ(balance.extra_kg(), 0.0);
}

// Who only asks what is missing.
TEST(MomentumBalance, WithoutRatesWhatIsMissingIsStillKnown) {
  MomentumBalance balance({.mass_kg = 90.0, .period_s = kPeriod_s});
  Axis axis;
  axis.noise_m = 0.0;
  axis.constant_N = -12.0;
  for (int k = 0; k < 20; ++k) balance.Learn(axis.Step(30.0), 30.0, 0.0);
  ASSERT_TRUE(balance.missing().known);
  EXPECT_NEAR(balance.missing().force_N, 12.0, 1e-6);
  EXPECT_EQ(balance.extra_kg(), 0.0);
  EXPECT_EQ(balance.delay_periods(), 0.0);
}

}  // namespace
}  // namespace contour
