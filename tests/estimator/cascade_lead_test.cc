#include "estimator/cascade_lead.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

constexpr double kLevel_N = 100.0, kPeriod_s = 1e-3;

struct Leading {
  CascadeLead lead{CascadeLead::Tuning{}, kPeriod_s};
  double noise_takes_s = 5.0;

  void For(double time_s, double unexplained_N, bool at_rest) {
    for (int i = 0; i < static_cast<int>(time_s / kPeriod_s); ++i)
      lead.Step(unexplained_N, kLevel_N, at_rest, noise_takes_s);
  }
};

TEST(CascadeLead, FollowsInMotionAndHardlyAtRest) {
  Leading moves, rests;
  for (Leading* l : {&moves, &rests}) l->For(0.01, 0.0, false);
  moves.For(0.06, 20.0, false);
  rests.For(0.06, 20.0, true);
  EXPECT_GT(moves.lead.lead_N(), 0.9 * 20.0);
  EXPECT_LT(rests.lead.lead_N(), 0.2 * 20.0);
}

TEST(CascadeLead, BeforeAnyMotionPartOfTheLevelWindsNothingUp) {
  Leading l;
  l.For(5.0, 0.29 * kLevel_N, true);
  EXPECT_EQ(l.lead.lead_N(), 0.0);
  l.For(1.0, 0.29 * kLevel_N, false);
  EXPECT_GT(l.lead.lead_N(), 0.28 * kLevel_N);
}

TEST(CascadeLead, TheLongerTheRestTheLessOfASingleReportComesThrough) {
  Leading soon, late;
  for (Leading* l : {&soon, &late}) l->For(0.01, 0.0, false);
  soon.For(1.0, 0.0, true);
  late.For(10.0, 0.0, true);
  for (Leading* l : {&soon, &late}) l->For(kPeriod_s, 400.0, true);
  EXPECT_NEAR(soon.lead.lead_N(), 400.0 * kPeriod_s * 2.5, 0.01);
  EXPECT_NEAR(late.lead.lead_N(), 400.0 * kPeriod_s, 0.01);
}

TEST(CascadeLead, AfterALongRestAForceIsStillFollowedWithinSeconds) {
  Leading l;
  l.For(0.01, 0.0, false);
  l.For(600.0, 0.0, true);
  l.For(3.0, 20.0, true);
  EXPECT_GT(l.lead.lead_N(), 0.9 * 20.0);
}

}  // namespace
}  // namespace contour
