#include "control/supervision_ladder.h"

#include <gtest/gtest.h>

#include "control/innovation_watch.h"

namespace contour {
namespace {

TEST(SupervisionLadder, OneStepForEveryAlarmAndOneBackAfterAQuietTime) {
  SupervisionLadder ladder(0, 100);
  ladder.Step(Reason::kOscillation, 1);
  EXPECT_EQ(ladder.step(), SupervisionStep::kNoticed);
  for (int i = 0; i < 99; ++i) ladder.Step(Reason::kNone, 0);
  EXPECT_EQ(ladder.step(), SupervisionStep::kNoticed);
  ladder.Step(Reason::kSolverCapLasting, 0);
  EXPECT_EQ(ladder.step(), SupervisionStep::kSoftened);
  for (int i = 0; i < 100; ++i) ladder.Step(Reason::kNone, 0);
  EXPECT_EQ(ladder.step(), SupervisionStep::kNoticed);
  EXPECT_EQ(ladder.reason(), Reason::kSolverCapLasting);
  for (int i = 0; i < 100; ++i) ladder.Step(Reason::kNone, 0);
  EXPECT_EQ(ladder.step(), SupervisionStep::kNone);
  EXPECT_EQ(ladder.reason(), Reason::kNone);
}

/// Up to softened by violence, and so many quiet times down again.
SupervisionLadder AfterViolence(int quiet_times) {
  SupervisionLadder ladder(50, 100);
  ladder.Step(Reason::kOscillation, 1, true);
  for (int i = 0; i < 50; ++i) ladder.Step(Reason::kOscillation, 1);
  EXPECT_EQ(ladder.step(), SupervisionStep::kSoftened);
  for (int i = 0; i < quiet_times * 100; ++i) ladder.Step(Reason::kNone, 0);
  return ladder;
}

// Before: softened and taken back without end, a burst for every quiet time.
TEST(SupervisionLadder, ViolenceThatReturnsWhenSoftnessIsTakenBackIsTheLastStep) {
  SupervisionLadder ladder = AfterViolence(1);
  ASSERT_EQ(ladder.step(), SupervisionStep::kNoticed);
  ladder.Step(Reason::kOscillation, 1, true);
  EXPECT_EQ(ladder.step(), SupervisionStep::kStopped);
  EXPECT_EQ(ladder.reason(), Reason::kOscillation);
}

// What is told first may be what the swing makes of a filter; the time to act is no excuse for the swing.
TEST(SupervisionLadder, ViolenceThatReturnsBehindAnotherAlarmIsTheLastStepToo) {
  SupervisionLadder ladder = AfterViolence(1);
  ladder.Step(Reason::kEstimatorInconsistent, 1);
  EXPECT_EQ(ladder.step(), SupervisionStep::kSoftened);
  ladder.Step(Reason::kOscillation, 1, true);
  EXPECT_EQ(ladder.step(), SupervisionStep::kStopped);
  EXPECT_EQ(ladder.reason(), Reason::kOscillation);
}

TEST(SupervisionLadder, WhatIsNotViolentOrLongPastStopsNothing) {
  SupervisionLadder mild = AfterViolence(1);
  mild.Step(Reason::kOscillation, 1);
  EXPECT_EQ(mild.step(), SupervisionStep::kSoftened);
  SupervisionLadder past = AfterViolence(2);
  ASSERT_EQ(past.step(), SupervisionStep::kNone);
  for (int i = 0; i < 51; ++i) past.Step(Reason::kOscillation, 1, true);
  EXPECT_EQ(past.step(), SupervisionStep::kSoftened);
  // What was softened for another reason has not swung yet.
  SupervisionLadder first(0, 100);
  first.Step(Reason::kCyclesLate, 0xFF);
  first.Step(Reason::kCyclesLate, 0xFF);
  for (int i = 0; i < 100; ++i) first.Step(Reason::kNone, 0);
  first.Step(Reason::kOscillation, 1, true);
  EXPECT_EQ(first.step(), SupervisionStep::kSoftened);
}

TEST(SupervisionLadder, TheLastStepStays) {
  SupervisionLadder ladder(0, 10);
  for (int i = 0; i < 5; ++i) ladder.Step(Reason::kOscillation, 1);
  for (int i = 0; i < 100; ++i) ladder.Step(Reason::kNone, 0);
  EXPECT_EQ(ladder.step(), SupervisionStep::kStopped);
  EXPECT_EQ(ladder.where(), 1);
  ladder.Reset();
  EXPECT_EQ(ladder.step(), SupervisionStep::kNone);
}

TEST(SupervisionLadder, AStepIsGivenTimeToAct) {
  SupervisionLadder ladder(50, 100);
  for (int i = 0; i < 50; ++i) ladder.Step(Reason::kOscillation, 0);
  EXPECT_EQ(ladder.step(), SupervisionStep::kNoticed);
  ladder.Step(Reason::kOscillation, 0);
  EXPECT_EQ(ladder.step(), SupervisionStep::kSoftened);
}

TEST(InARow, OneMissBeginsAnew) {
  InARow watch(3);
  EXPECT_FALSE(watch.Step(true) || watch.Step(true) || watch.Step(false) || watch.Step(true) ||
               watch.Step(true));
  EXPECT_TRUE(watch.Step(true));
  EXPECT_FALSE(watch.Step(true));
  InARow off(0);
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(off.Step(true));
}

TEST(InnovationWatch, ToldWhenTheMeanSquareStaysAboveForAllItsSamples) {
  InnovationWatch watch({.sigma = 10.0, .samples = 100, .gated = 5});
  int told = 0;
  for (int i = 0; i < 10000; ++i) told += watch.Step(8.0, 1.0, false) ? 1 : 0;
  EXPECT_EQ(told, 0);
  EXPECT_NEAR(watch.mean_square(), 64.0, 1.0);
  int after = 0;
  while (!watch.Step(20.0, 1.0, false)) ++after;
  EXPECT_GT(after, 100);
  EXPECT_LT(after, 200);
  EXPECT_FALSE(watch.Step(20.0, 0.0, false)) << "no measurement, nothing to judge";
}

TEST(InnovationWatch, MeasurementsThatAreNotBelievedCountInARow) {
  InnovationWatch watch({.sigma = 10.0, .samples = 100, .gated = 5});
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(watch.Step(1e4, 1.0, true));
  EXPECT_TRUE(watch.Step(1e4, 1.0, true));
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(watch.Step(1e4, 1.0, true));
  EXPECT_FALSE(watch.Step(0.0, 1.0, false));
  EXPECT_FALSE(watch.Step(1e4, 1.0, true));
}

}  // namespace
}  // namespace contour
