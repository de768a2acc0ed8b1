#include "estimator/friction_preview.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

const Friction kFriction{52, 47, 42, 36, 2e-3, 1, 5e6, 0, 2e-3, 500};
constexpr double kPeriod_s = 1e-3;

ReferencePoint Sine(double t) {
  const double a = 100e-6, w = 5.0;
  return {a * std::sin(w * t), a * w * std::cos(w * t), -a * w * w * std::sin(w * t)};
}

AxisHorizon Horizon(int k, int points) {
  AxisHorizon h;
  for (int j = 0; j < points; ++j) h.push_back(Sine((k + j) * kPeriod_s));
  return h;
}

const KnownEffects kNoEffects;
const AngleForceMap kNoMap;
const KnownNow kNothingKnown{kNoEffects, std::nan(""), kNoMap, 0.0, 0.0, kFriction.sigma0_N_m};

TEST(FrictionRoll, FollowsTheBristleAlongTheReference) {
  const SevenStateModel model(kFriction, 89.0, kPeriod_s, 0.2);
  FrictionRoll roll(kPeriod_s);
  LevelCorrection correction({5e-3, 2e-3, 0.0, 0.0});
  ViscousCorrection viscous({500.0, 0.0});
  StateVector<kSevenStates> x{};
  x[kLevelPlus] = 42;
  x[kLevelMinus] = 36;
  // Truth: the same law in fine steps along the same motion, its bristle handed over as the estimate.
  double bristle = 0.0;
  const int fine = 100;
  FrictionPreview preview;
  std::array<double, 6> ahead{};
  for (int k = 0; k < 4000; ++k) {
    x[kBristle] = bristle;
    roll.Run(model, x, correction, viscous, kNothingKnown, false, Horizon(k, 6), kMaxHorizonPoints, preview);
    ASSERT_EQ(preview.size(), 6u);
    double f = bristle;
    for (std::size_t j = 0; j < 6; ++j) {
      const double t0 = (k + static_cast<double>(j)) * kPeriod_s;
      ahead[j] = f + 500.0 * Sine(t0).velocity_m_s;
      double mean = 0.0;
      for (int i = 0; i < fine; ++i) {
        const double v = Sine(t0 + (i + 0.5) * kPeriod_s / fine).velocity_m_s;
        const double next = BristleAfter(f, v, 5e6, FrictionLevel(kFriction, v), kPeriod_s / fine);
        mean += (0.5 * (f + next) + 500.0 * v) / fine;
        f = next;
      }
      if (k > 1) {
        EXPECT_NEAR(preview[j].node_N, ahead[j], 0.15) << k << " " << j;
        EXPECT_NEAR(preview[j].mid_N, mean, 0.15) << k << " " << j;
      }
      if (j == 0) bristle = f;
    }
  }
}

TEST(FrictionRoll, AnOffsetOfTheEstimateIsKept) {
  const SevenStateModel model(kFriction, 89.0, kPeriod_s, 0.2);
  LevelCorrection correction({5e-3, 2e-3, 0.0, 0.0});
  ViscousCorrection viscous({500.0, 0.0});
  StateVector<kSevenStates> x{};
  x[kLevelPlus] = 42;
  x[kLevelMinus] = 36;
  FrictionRoll a(kPeriod_s), b(kPeriod_s);
  FrictionPreview pa, pb;
  a.Run(model, x, correction, viscous, kNothingKnown, false, Horizon(0, 10), kMaxHorizonPoints, pa);
  x[kBristle] += 3.0;
  x[kDisturbance] += 4.0;
  b.Run(model, x, correction, viscous, kNothingKnown, false, Horizon(0, 10), kMaxHorizonPoints, pb);
  for (std::size_t j = 0; j < 10; ++j) {
    EXPECT_NEAR(pb[j].node_N - pa[j].node_N, 7.0, 1e-12);
    EXPECT_NEAR(pb[j].mid_N - pa[j].mid_N, 7.0, 1e-12);
  }
}

TEST(FrictionRoll, AtRestTheEstimateHoldsOverTheWholeHorizon) {
  const SevenStateModel model(kFriction, 89.0, kPeriod_s, 0.2);
  LevelCorrection correction({5e-3, 2e-3, 0.0, 0.0});
  ViscousCorrection viscous({500.0, 0.0});
  StateVector<kSevenStates> x{};
  x[kLevelPlus] = 42;
  x[kLevelMinus] = 36;
  x[kBristle] = -17.0;
  x[kDisturbance] = 2.0;
  FrictionRoll roll(kPeriod_s);
  roll.Reset(30.0);
  AxisHorizon still(kMaxHorizonPoints);
  FrictionPreview preview;
  roll.Run(model, x, correction, viscous, kNothingKnown, true, still, kMaxHorizonPoints, preview);
  ASSERT_EQ(preview.size(), kMaxHorizonPoints);
  for (const auto& f : preview) {
    EXPECT_DOUBLE_EQ(f.node_N, -15.0);
    EXPECT_DOUBLE_EQ(f.mid_N, -15.0);
  }
  AxisHorizon none;
  roll.Run(model, x, correction, viscous, kNothingKnown, true, none, kMaxHorizonPoints, preview);
  EXPECT_TRUE(preview.empty());
}

/// An axis of which nothing is learnt, with levels other than commissioned.
struct Unlearning {
  Friction f{52, 47, 42, 36, 2e-3, 1, 5e6, 3000, 2e-3, 500};
  SevenStateModel model{f, 89.0, kPeriod_s, 0.2};
  LevelCorrection correction{{5e-3, 2e-3, 0.0, 0.0}};
  ViscousCorrection viscous{{500.0, 0.0}};
  StateVector<kSevenStates> x{};

  Unlearning() {
    x[kLevelPlus] = 43;
    x[kLevelMinus] = 35;
  }
};

// Any length of the roll, whole vectors or not, both directions and a reversal, against the law point by
// point.
TEST(FrictionRoll, EveryPointIsThatOfTheLaw) {
  Unlearning a;
  a.x[kBristle] = 20;
  Friction estimated = a.f;
  estimated.Fc_plus_N = 43, estimated.Fs_plus_N = 52.0 / 42.0 * 43;
  estimated.Fc_minus_N = 35, estimated.Fs_minus_N = 47.0 / 36.0 * 35;
  const AxisHorizon h = Horizon(300, 40);  // reverses after 14 points
  for (const std::size_t points : {1u, 4u, 23u, 39u, 40u}) {
    FrictionRoll roll(kPeriod_s);
    roll.Reset(20.0);
    FrictionPreview preview;
    roll.Run(a.model, a.x, a.correction, a.viscous, kNothingKnown, false, h, points, preview);
    ASSERT_EQ(preview.size(), points);
    double bristle = 20.0;
    for (std::size_t j = 0; j < points; ++j) {
      const double here = h[j].velocity_m_s;
      const double v = 0.5 * (here + h[std::min<std::size_t>(j + 1, 39)].velocity_m_s);
      const double level = FrictionLevel(estimated, v);
      const double next = BristleAfter(bristle, v, a.f.sigma0_N_m, level, kPeriod_s);
      const double middle = 0.5 * (bristle + next);
      EXPECT_NEAR(preview[j].node_N, bristle + BristleDamping(a.f, bristle, here, level) + 500.0 * here,
                  1e-9);
      EXPECT_NEAR(preview[j].mid_N, middle + BristleDamping(a.f, middle, v, level) + 500.0 * v, 1e-9);
      bristle = next;
    }
  }
}

// What is kept from cycle to cycle changes nothing: a roll that has followed the reference gives the bits of
// one that sees it for the first time, through jumps and other lengths too.
TEST(FrictionRoll, WhatWasSeenBeforeLeavesNoTrace) {
  Unlearning a;
  FrictionRoll following(kPeriod_s);
  for (int k = 0; k < 400; ++k) {
    a.x[kBristle] = 40.0 * std::cos(5.0 * kPeriod_s * k);
    const int at = k / 150 * 37 + k % 150 / 50 * 3 + k;  // jumps now and then
    AxisHorizon h = Horizon(at, 24);
    if (k % 100 > 95) h[17].acceleration_m_s2 += 1.0;
    if (k % 100 > 90 && k % 100 < 95) h[23].position_m += 1e-9;
    const std::size_t points = k % 200 < 150 ? 23 : 17;
    following.Reset(a.x[kBristle]);
    FrictionRoll fresh(kPeriod_s);
    fresh.Reset(a.x[kBristle]);
    FrictionPreview kept, anew;
    following.Run(a.model, a.x, a.correction, a.viscous, kNothingKnown, false, h, points, kept);
    fresh.Run(a.model, a.x, a.correction, a.viscous, kNothingKnown, false, h, points, anew);
    ASSERT_EQ(kept.size(), anew.size());
    for (std::size_t j = 0; j < kept.size(); ++j) {
      ASSERT_EQ(kept[j].node_N, anew[j].node_N) << k << " " << j;
      ASSERT_EQ(kept[j].mid_N, anew[j].mid_N) << k << " " << j;
    }
  }
}

TEST(FrictionRoll, RippleOfTheLevelShowsAhead) {
  const SevenStateModel model(kFriction, 89.0, kPeriod_s, 0.2);
  LevelCorrection correction({5e-3, 2e-3, 0.5, 0.0});
  ViscousCorrection viscous({500.0, 0.0});
  for (int k = 0; k < 20000; ++k) {
    const auto basis = correction.Basis(k * 1e-5, 0.05);
    const double truth = 1.0 + 0.08 * basis[1];
    correction.Learn(basis, true, 0.01, truth - correction.Factor(basis, true), 1e-5, true);
  }
  StateVector<kSevenStates> x{};
  x[kLevelPlus] = 42;
  x[kLevelMinus] = 36;
  x[kBristle] = 42;
  AxisHorizon h;
  for (int j = 0; j < 40; ++j) h.push_back({j * 50e-6, 50e-3, 0.0});
  FrictionRoll roll(kPeriod_s);
  roll.Reset(42.0);
  FrictionPreview preview;
  roll.Run(model, x, correction, viscous, kNothingKnown, false, h, kMaxHorizonPoints, preview);
  // After 1.25 mm, a quarter turn, the level stands 8 % up; sigma2 v = 25 N beside it.
  EXPECT_NEAR(preview[25].node_N, 42.0 * 1.08 + 25.0, 0.5);
}

TEST(FrictionRoll, WhatTheAxisIsHeavierThanCommissionedMustBePushedToo) {
  const SevenStateModel model(kFriction, 89.0, kPeriod_s, 0.2);
  LevelCorrection correction({5e-3, 2e-3, 0.0, 0.0});
  ViscousCorrection viscous({500.0, 0.0});
  const KnownNow heavier{kNoEffects, std::nan(""), kNoMap, 5.0, 0.0, kFriction.sigma0_N_m};
  StateVector<kSevenStates> x{};
  x[kLevelPlus] = 42;
  x[kLevelMinus] = 36;
  AxisHorizon h;
  for (int j = 0; j < 5; ++j) h.push_back({0.0, 0.0, 2.0});
  FrictionRoll roll(kPeriod_s);
  FrictionPreview preview;
  roll.Run(model, x, correction, viscous, heavier, true, h, kMaxHorizonPoints, preview);
  EXPECT_NEAR(preview[1].mid_N, 10.0, 0.01);
  EXPECT_NEAR(preview[1].node_N, 0.0, 1e-12);  // the motor's mass does not wind the screw up
}

}  // namespace
}  // namespace contour
