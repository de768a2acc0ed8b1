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
