#include "control/standstill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace contour {
namespace {

using Motion = Standstill::Motion;

constexpr double kPeriod_s = 1e-3;
constexpr double kStep_N = 0.8;

/// An axis on its bristles, well damped: the table follows the force, rounded to what can be sent.
struct Held {
  double stiffness_N_m;
  double outside_N = 0.0;
  double sent_N = 0.0;
  double position_m = 0.0;
  int changes = 0;

  void Send(double force_N) {
    const double rounded_N = kStep_N * std::round(force_N / kStep_N);
    changes += rounded_N != sent_N ? 1 : 0;
    sent_N = rounded_N;
    position_m += 0.1 * ((sent_N - outside_N) / stiffness_N_m - position_m);
  }
};

StandstillBounds Bounds() { return {kStep_N, kStep_N / 4e6, 5e-9, kPeriod_s}; }

TEST(Standstill, BeginsOnceTheErrorIsSmallAndEndsBeforeAMotion) {
  Standstill stand(Bounds());
  int cycles = 0;
  while (!stand.Step(1e-7, 10.0, Motion::kNone) && cycles < 1000) ++cycles;
  EXPECT_EQ(cycles, 49);
  EXPECT_FALSE(stand.Step(1e-7, 10.0, Motion::kOwn).has_value());
  EXPECT_FALSE(stand.Step(1e-7, 10.0, Motion::kNone).has_value()) << "it begins anew";
}

// Near the level of its friction it would creep under a constant force; one that has come to rest before is
// left alone.
TEST(Standstill, AnAxisThatWaitsForOthersIsHeldByItsLoop) {
  Standstill stand(Bounds());
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(stand.Step(1e-7, 10.0, Motion::kOfOthers).has_value()) << i;
  for (int i = 0; i < 100; ++i) stand.Step(1e-7, 10.0, Motion::kNone);
  ASSERT_TRUE(stand.standing());
  EXPECT_TRUE(stand.Step(1e-7, 10.0, Motion::kOfOthers).has_value());
}

TEST(Standstill, AnAxisThatFrictionCannotHoldIsNeverLeftAlone) {
  StandstillBounds bounds = Bounds();
  bounds.step_moves_m = 0.0;
  Standstill stand(bounds);
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(stand.Step(0.0, 10.0, Motion::kNone).has_value());
}

// With friction's stiffness as stated, and a third and three times of it.
TEST(Standstill, BringsTheAxisWithinAStepAndThenSendsOneTorque) {
  for (const double factor : {1.0 / 3.0, 1.0, 3.0}) {
    Held axis{4e6 * factor};
    Standstill stand(Bounds());
    for (int i = 0; i < 80; ++i) axis.Send(stand.Step(0.0, axis.sent_N, Motion::kNone).value_or(0.0));
    axis.outside_N = 1.5 * kStep_N * std::min(1.0, factor);  // some creep, after the axis was let go
    for (int i = 0; i < 4000; ++i)
      axis.Send(stand.Step(axis.position_m, axis.sent_N, Motion::kNone).value_or(0.0));
    const double a_step_m = kStep_N / std::min(axis.stiffness_N_m, 4e6);
    EXPECT_LT(std::abs(axis.position_m), a_step_m) << factor;
    const int before = axis.changes;
    for (int i = 0; i < 2000; ++i)
      axis.Send(stand.Step(axis.position_m, axis.sent_N, Motion::kNone).value_or(0.0));
    EXPECT_EQ(axis.changes, before) << factor;
  }
}

// What holds an axis that has just been enabled is friction, as before.
TEST(Standstill, AnAxisThatIsEnabledAtRestIsHeldFromTheFirstCycleOn) {
  Standstill stand(Bounds());
  stand.Begin(1e-7, 0.4 * kStep_N);
  ASSERT_TRUE(stand.standing());
  EXPECT_EQ(stand.Step(1e-7, 0.0, Motion::kOfOthers), 0.0);
}

// Whether friction or a brake bore the weight is not known: what is planned for it may push the axis off.
TEST(Standstill, AnAxisUnderAWeightIsTheLoopsWhenItIsEnabled) {
  for (const double planned_N : {-10.0, 0.6 * kStep_N}) {
    Standstill stand(Bounds());
    stand.Begin(0.0, planned_N);
    EXPECT_FALSE(stand.standing()) << planned_N;
    EXPECT_FALSE(stand.Step(0.0, 0.0, Motion::kOfOthers).has_value()) << planned_N;
  }
}

// A force that turns out not to hold it is given up by the first reading that says so.
TEST(Standstill, AnAxisThatSinksWhenItIsEnabledIsTheLoopsAtOnce) {
  const double unit_m = kStep_N / 4e6;
  Standstill stand(Bounds());
  stand.Begin(0.0, 0.0);
  ASSERT_TRUE(stand.Step(3.9 * unit_m, 0.0, Motion::kNone).has_value());
  EXPECT_FALSE(stand.Step(4.1 * unit_m, 0.0, Motion::kNone).has_value());
  Standstill far(Bounds());
  far.Begin(4.1 * unit_m, 0.0);
  EXPECT_FALSE(far.standing());
  StandstillBounds loose = Bounds();
  loose.step_moves_m = 0.0;
  Standstill never(loose);
  never.Begin(0.0, 0.0);
  EXPECT_FALSE(never.standing());
}

// Readings that flicker between two counts show by their mean what is less than one.
TEST(Standstill, AnErrorOfAShareOfACountIsTakenBack) {
  StandstillBounds bounds = Bounds();
  bounds.count_m = 3.0 * bounds.step_moves_m;
  Held axis{4e6};
  Standstill stand(bounds);
  stand.Begin(0.0, 0.0);
  axis.outside_N = -1.2 * kStep_N;
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> noise(-0.5, 0.5);
  for (int i = 0; i < 3000; ++i) {
    const double read_m = bounds.count_m * std::round(axis.position_m / bounds.count_m + noise(random));
    axis.Send(stand.Step(read_m, axis.sent_N, Motion::kOfOthers).value_or(0.0));
  }
  EXPECT_TRUE(stand.standing());
  EXPECT_LT(std::abs(axis.position_m), 0.8 * bounds.step_moves_m);
}

// How far the force goes while the table is seen at one place, whatever is sent.
double GoesBy_N(Standstill& stand, double error_m, int cycles) {
  double sent_N = 8.0 * kStep_N, farthest_N = 0.0;
  for (int i = 0; i < cycles; ++i) {
    const double force_N = stand.Step(error_m, sent_N, Motion::kNone).value_or(sent_N);
    sent_N = kStep_N * std::round(force_N / kStep_N);
    farthest_N = std::max(farthest_N, std::abs(sent_N - 8.0 * kStep_N));
  }
  return farthest_N;
}

// Near the level of friction creep takes back what the first step moved: that says nothing of the bristles,
// and a force that goes by as many steps as if they were ten times as stiff throws the axis over.
TEST(Standstill, AStepThatCreepHidesIsNotFollowedByTooMany) {
  const double unit_m = kStep_N / 4e6;
  Standstill stand(Bounds());
  GoesBy_N(stand, 0.0, 60);
  ASSERT_TRUE(stand.standing());
  // One step, then twice the error over what a step moves.
  EXPECT_NEAR(GoesBy_N(stand, 2.6 * unit_m, 450), (1.0 + 5.0) * kStep_N, 1e-9);
}

// Once friction has settled, stepping about costs more than an error of a step.
TEST(Standstill, AnErrorOfAStepIsTakenBackAtFirstAndLeftLater) {
  const double unit_m = kStep_N / 4e6;
  for (const bool late : {false, true}) {
    Standstill stand(Bounds());
    GoesBy_N(stand, 0.0, late ? 2000 : 60);
    ASSERT_TRUE(stand.standing());
    EXPECT_NEAR(GoesBy_N(stand, 1.2 * unit_m, 250), late ? 0.0 : kStep_N, 1e-9) << late;
    EXPECT_GT(GoesBy_N(stand, 2.0 * unit_m, 250), 0.9 * kStep_N) << "more is taken back at any time";
  }
}

// Of an axis that swings on its bristles with little damping: how far its table swings once it was brought
// back by one step.
double SwingsAfterACorrection_m(double swings_s, double told_s) {
  constexpr double kMass_kg = 1000.0, kDamping = 0.03;
  const double swings_1_s = 2.0 * std::numbers::pi / swings_s;
  const double stiffness_N_m = kMass_kg * swings_1_s * swings_1_s;
  StandstillBounds bounds{kStep_N, kStep_N / stiffness_N_m, 5e-9, kPeriod_s};
  bounds.swings_s = told_s;
  Standstill stand(bounds);
  double position_m = 0.0, velocity_m_s = 0.0, sent_N = 0.0, outside_N = 0.0, low_m = 1.0, high_m = -1.0;
  bool corrected = false;
  for (int i = 0; i < 1500; ++i) {
    if (i == 80) outside_N = 1.2 * kStep_N;
    // It crept to where it is held now.
    if (i == 80) position_m = -outside_N / stiffness_N_m;
    const double force_N = stand.Step(position_m, sent_N, Motion::kNone).value_or(0.0);
    sent_N = kStep_N * std::round(force_N / kStep_N);
    const double sum_N = sent_N - outside_N - stiffness_N_m * position_m;
    velocity_m_s += kPeriod_s * (sum_N / kMass_kg - 2.0 * kDamping * swings_1_s * velocity_m_s);
    position_m += kPeriod_s * velocity_m_s;
    // The force has come to the next step, and stays there.
    corrected = corrected || force_N == kStep_N;
    if (!corrected) continue;
    low_m = std::min(low_m, position_m);
    high_m = std::max(high_m, position_m);
  }
  EXPECT_TRUE(corrected);
  return (high_m - low_m) / (kStep_N / stiffness_N_m);
}

TEST(Standstill, ACorrectionIsSlowAgainstWhatTheAxisSwingsIn) {
  EXPECT_LT(SwingsAfterACorrection_m(0.17, 0.17), 0.15);
  // Also where the bristles are half as stiff, or half as much again.
  EXPECT_LT(SwingsAfterACorrection_m(0.24, 0.17), 0.4);
  EXPECT_LT(SwingsAfterACorrection_m(0.14, 0.17), 0.4);
  EXPECT_GT(SwingsAfterACorrection_m(0.17, 0.0), 0.7) << "which is what it would do at the usual ramp";
}

RestingAxis Resting() {
  return {.mass_kg = 100.0,
          .step_N = kStep_N,
          .friction_N = 40.0,
          .sigma0_N_m = 4e6,
          .sigma1_Ns_m = 3000.0,
          .regulator_Hz = 20.0};
}

TEST(Standstill, FrictionHoldsAnAxisThatHasEnoughOfItAndRingsNotForLong) {
  RestingAxis axis = Resting();
  EXPECT_EQ(WhatHolds(axis), Holder::kFriction);
  const StandstillBounds bounds = BoundsOf(axis, 5e-9, kPeriod_s);
  EXPECT_DOUBLE_EQ(bounds.step_moves_m, kStep_N / 4e6);
  EXPECT_NEAR(bounds.swings_s, 2.0 * std::numbers::pi * std::sqrt(100.0 / 4e6), 1e-12);

  axis.friction_N = 4.9 * kStep_N;
  EXPECT_EQ(WhatHolds(axis), Holder::kLoopFewSteps);
  EXPECT_EQ(BoundsOf(axis, 5e-9, kPeriod_s).step_moves_m, 0.0);

  // A motor that is 5 t at the table, as a lead of 2 mm makes it.
  axis = Resting();
  axis.mass_kg = 5000.0;
  EXPECT_EQ(WhatHolds(axis), Holder::kLoopLongRinging);
  EXPECT_EQ(BoundsOf(axis, 5e-9, kPeriod_s).step_moves_m, 0.0);
  axis.sigma1_Ns_m = 60e3;
  EXPECT_EQ(WhatHolds(axis), Holder::kFriction) << "damped well";
  axis.sigma1_Ns_m = 3000.0;
  axis.regulator_Hz = 4.0;
  EXPECT_EQ(WhatHolds(axis), Holder::kFriction) << "better than the loop";
}

/// A table on bristles that give way at the level of its friction, behind a screw; its loop answers what a
/// screw as stated makes of the motor's place, and integrates it, until it is told to hold.
class TableBehindAScrew {
 public:
  explicit TableBehindAScrew(double stiffer) : stiffer_(stiffer) {}

  /// From top to bottom of the table's place from `from_s` on, in what friction winds the screw up by.
  double Swings(const StandstillBounds& bounds, double from_s, double to_s) {
    Standstill stand(bounds);
    double force_N = 30.0, held_m = -1e-6, low_m = 1.0, high_m = -1.0;
    for (int i = 0; i * kPeriod_s < to_s; ++i) {
      const double sent_N = kStep_N * std::round(force_N / kStep_N);
      const double beyond_N = std::abs(sent_N) - kFriction_N;
      if (beyond_N > 0.0) held_m += std::copysign(beyond_N * kPeriod_s / kSlides_Ns_m, sent_N);
      const double table_m = held_m + sent_N / kSigma0_N_m;
      const double seen_m = table_m + sent_N / (stiffer_ * kStiffness_N_m) - sent_N / kStiffness_N_m;
      looped_N_ -= kIntegral_N_ms * seen_m * kPeriod_s;
      const std::optional<double> constant_N = stand.Step(seen_m, sent_N, Motion::kNone);
      // It takes over from the force that acts.
      if (constant_N) looped_N_ = *constant_N + kProportional_N_m * seen_m;
      force_N = looped_N_ - kProportional_N_m * seen_m;
      if (i * kPeriod_s < from_s) continue;
      low_m = std::min(low_m, table_m);
      high_m = std::max(high_m, table_m);
    }
    return (high_m - low_m) / (kFriction_N / kStiffness_N_m);
  }

  static constexpr double kFriction_N = 95.0, kStiffness_N_m = 4e6, kSigma0_N_m = 46e6;

 private:
  static constexpr double kSlides_Ns_m = 1e6, kIntegral_N_ms = 3e7, kProportional_N_m = 1e7;
  double stiffer_;
  double looped_N_ = 30.0;
};

// The loop drives the table the way the force goes, from one level of friction to the other.
TEST(Standstill, ALoopThatHuntsByAScrewStifferThanStatedIsHeld) {
  RestingAxis axis = Resting();
  axis.friction_N = TableBehindAScrew::kFriction_N;
  axis.stiffness_N_m = TableBehindAScrew::kStiffness_N_m;
  axis.sigma0_N_m = TableBehindAScrew::kSigma0_N_m;
  const StandstillBounds bounds = BoundsOf(axis, 3e-9, kPeriod_s);
  StandstillBounds never = bounds;
  never.doubt_m = never.relief_N = 0.0;
  for (const double stiffer : {1.15, 1.2, 1.25}) {
    const double hunts = TableBehindAScrew(stiffer).Swings(never, 10.0, 20.0);
    EXPECT_GT(hunts, 0.2) << stiffer;
    EXPECT_LT(hunts, 5.0) << stiffer << ": it runs away";
    EXPECT_LT(TableBehindAScrew(stiffer).Swings(bounds, 3.0, 20.0), 0.05) << stiffer;
  }
}

// Where the table is measured there is no doubt.
TEST(Standstill, OnlyATableThatIsNotMeasuredIsHeldWithinADoubt) {
  RestingAxis axis = Resting();
  EXPECT_EQ(BoundsOf(axis, 5e-9, kPeriod_s).doubt_m, 0.0);
  axis.stiffness_N_m = 4e6;
  const StandstillBounds bounds = BoundsOf(axis, 5e-9, kPeriod_s);
  EXPECT_NEAR(bounds.doubt_m, 0.1 * axis.friction_N / 4e6, 1e-15);
  Standstill stand(bounds);
  int cycles = 0;
  while (!stand.Step(0.9 * bounds.doubt_m, 10.0, Motion::kNone) && cycles < 10000) ++cycles;
  EXPECT_GT(cycles, 500) << "the loop has its time";
  EXPECT_LT(cycles, 2000);
  EXPECT_TRUE(stand.Step(2.5 * bounds.doubt_m, 10.0, Motion::kNone).has_value());
  while (stand.Step(4.0 * bounds.doubt_m, 10.0, Motion::kNone) && cycles < 10000) ++cycles;
  EXPECT_LT(cycles, 2100) << "what is more is for the loop";
}

TEST(Standstill, WhatIsLargerThanSomeStepsIsForTheLoop) {
  Standstill stand(Bounds());
  for (int i = 0; i < 100; ++i) stand.Step(0.0, 10.0, Motion::kNone);
  ASSERT_TRUE(stand.standing());
  int cycles = 0;
  while (stand.Step(5e-6, 10.0, Motion::kNone) && cycles < 100) ++cycles;
  EXPECT_LE(cycles, 3);
}

}  // namespace
}  // namespace contour
