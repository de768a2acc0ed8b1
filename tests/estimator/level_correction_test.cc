#include "estimator/level_correction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace contour {
namespace {

constexpr double kLead_m = 5e-3;
constexpr LevelCorrection::Tuning kTuning{kLead_m, 2e-3, 0.1, 0.2};

// The bristle as it follows its level: relaxes by 1 - kept per period.
struct Follower {
  double value = 1.0;
  void Step(double level, double kept) { value = kept * value + (1.0 - kept) * level; }
};

TEST(LevelCorrection, ManyPlacesAtOnceAreTheSameAsOneByOne) {
  LevelCorrection correction(kTuning);
  for (int k = 0; k < 500; ++k) {
    const bool forward = k % 100 < 50;
    const double p = 37e-6 * k, v = forward ? 0.003 : -0.004;
    correction.Learn(correction.Basis(p, v), forward, 0.1, 0.05 * std::sin(1e3 * p), v * 1e-3, true);
  }
  constexpr std::size_t kPlaces = 8;
  std::array<double, kPlaces> position{}, velocity{}, factor{};
  for (std::size_t k = 0; k < kPlaces; ++k) {
    position[k] = 0.7e-3 * static_cast<double>(k) - 2e-3;
    velocity[k] = 1e-3 * (3.0 - static_cast<double>(k));
  }
  std::array<std::array<double, kPlaces>, LevelCorrection::kTerms> basis{};
  correction.Basis(position, velocity, kPlaces, basis);
  for (std::size_t from = 0; from < kPlaces; from += 4) {
    std::array<const double*, LevelCorrection::kTerms> rows{};
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = &basis[i][from];
    wide::Quad four_velocities, four;
    wide::Load(&velocity[from], four_velocities);
    correction.Factors(rows, four_velocities, four);
    wide::Store(&factor[from], four);
  }
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const auto one = correction.Basis(position[k], velocity[k]);
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_DOUBLE_EQ(basis[i][k], one[i]);
    EXPECT_NEAR(factor[k], correction.Factor(one, velocity[k] >= 0.0), 1e-15);
    EXPECT_NE(factor[k], 1.0);
  }
}

TEST(LevelCorrection, LearnsTheRippleOfEachDirection) {
  LevelCorrection correction(kTuning);
  const auto truth = [](double p, bool forward) {
    const double angle = 2.0 * std::numbers::pi * p / kLead_m;
    return forward ? 1.0 + 0.08 * std::sin(angle + 0.7)
                   : 1.0 + 0.05 * std::cos(2.0 * angle) - 0.03 * std::sin(angle);
  };
  const double step = 50e-6, kept = 0.1;
  for (int sweep = 0; sweep < 10; ++sweep) {
    const bool forward = sweep % 2 == 0;
    Follower real, rolled;
    for (int k = 0; k < 1000; ++k) {
      const double p = forward ? k * step : (1000 - k) * step;
      const double v = forward ? 0.05 : -0.05;
      const auto basis = correction.Basis(p, v);
      const double force = forward ? 1.0 : -1.0;
      correction.Learn(basis, forward, kept, force * (real.value - rolled.value), v * 1e-3, true);
      real.Step(truth(p, forward), kept);
      rolled.Step(correction.Factor(basis, forward), kept);
    }
  }
  for (double p = 0.0; p < kLead_m; p += 1e-4) {
    EXPECT_NEAR(correction.Factor(correction.Basis(p, 0.05), true), truth(p, true), 0.005) << p;
    EXPECT_NEAR(correction.Factor(correction.Basis(p, -0.05), false), truth(p, false), 0.005) << p;
  }
}

TEST(LevelCorrection, LearnsTheRiseAtLowSpeedFromReversals) {
  LevelCorrection correction(kTuning);
  double p = 0.0;
  Follower real, rolled;
  for (int k = 0; k < 100000; ++k) {
    const double v = 0.05 * std::sin(0.005 * k) + 1e-9;
    const bool forward = v >= 0.0;
    const auto basis = correction.Basis(p, v);
    const double force = forward ? 1.0 : -1.0;
    const double kept = std::exp(-std::abs(v) * 1e-3 / 10e-6);
    correction.Learn(basis, forward, kept, force * (real.value - rolled.value), v * 1e-3, true);
    real.Step(forward ? 1.0 + 0.2 * basis[4] : 1.0 - 0.1 * basis[4], kept);
    rolled.Step(correction.Factor(basis, forward), kept);
    p += v * 1e-3;
  }
  EXPECT_NEAR(correction.plus()[4], 0.2, 0.06);
  EXPECT_NEAR(correction.minus()[4], -0.1, 0.06);
}

// As much is learnt in a second of short cycles as in a second of long ones.
TEST(LevelCorrection, LearnsBySecondsNotByCycles) {
  const auto learnt = [](double period_s) {
    LevelCorrection correction({kLead_m, 2e-3, 0.0, 0.05, period_s});
    Follower real, rolled;
    for (int k = 0; k < std::lround(4.0 / period_s); ++k) {
      const double v = 0.05 * std::sin(5.0 * (k + 0.5) * period_s);
      const bool forward = v >= 0.0;
      const auto basis = correction.Basis(0.0, v);
      const double kept = std::exp(-std::abs(v) * period_s / 10e-6);
      const double force = forward ? 1.0 : -1.0;
      correction.Learn(basis, forward, kept, force * (real.value - rolled.value), v * period_s, true);
      real.Step(1.0 + 0.2 * basis[4], kept);
      rolled.Step(correction.Factor(basis, forward), kept);
    }
    return correction.plus()[4];
  };
  const double usual = learnt(1e-3);
  EXPECT_GT(usual, 0.02);
  EXPECT_LT(usual, 0.18);  // on the way, not there
  EXPECT_NEAR(learnt(0.5e-3), usual, 0.1 * usual);
}

TEST(LevelCorrection, WithoutHighSpeedTheLowSpeedTermIsLeftAlone) {
  // It could not be told from the level itself.
  LevelCorrection correction(kTuning);
  const auto basis = correction.Basis(0.0, 1e-4);
  for (int k = 0; k < 20000; ++k) correction.Learn(basis, true, 0.5, 0.1, 0.0, true);
  for (const double c : correction.plus()) EXPECT_EQ(c, 0.0);  // and without travel no ripple is learnt
}

TEST(LevelCorrection, AnErrorOfTheWholeLevelIsNotTakenForAStribeckRise) {
  LevelCorrection correction(kTuning);
  for (int k = 0; k < 20000; ++k) {
    const double v = 0.03 + 0.0299 * std::sin(0.005 * k);
    correction.Learn(correction.Basis(0.0, v), true, 0.3, 0.1, 0.0, true);
  }
  EXPECT_LT(std::abs(correction.plus()[4]), 0.01);
}

TEST(LevelCorrection, WithoutSlidingNothingIsLearnt) {
  LevelCorrection correction(kTuning);
  for (int k = 0; k < 100000; ++k)
    correction.Learn(correction.Basis(1e-6 * k, 1e-3), true, 1.0, 0.3, 1e-6, true);
  for (int k = 0; k < 1000; ++k)
    correction.Learn(correction.Basis(1e-6 * k, 0.05), true, 0.5, 0.3, 1e-6, false);
  for (const double c : correction.plus()) EXPECT_EQ(c, 0.0);
  for (const double c : correction.minus()) EXPECT_EQ(c, 0.0);
}

TEST(LevelCorrection, FactorIsBounded) {
  LevelCorrection correction({kLead_m, 2e-3, 1.0, 1.0});
  for (int k = 0; k < 10000; ++k) {
    correction.Learn(correction.Basis(k * 1e-4, 0.1), true, 0.1, 100.0, 1e-4, true);
    const double factor = correction.Factor(correction.Basis(k * 1.3e-4, 0.1), true);
    ASSERT_GE(factor, 0.5);
    ASSERT_LE(factor, 1.5);
  }
  correction.Reset();
  EXPECT_EQ(correction.Factor(correction.Basis(1e-3, 0.0), true), 1.0);
}

}  // namespace
}  // namespace contour
