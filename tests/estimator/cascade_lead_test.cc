#include "estimator/cascade_lead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

constexpr double kLevel_N = 100.0, kPeriod_s = 1e-3;

struct Leading {
  CascadeLead lead{CascadeLead::Tuning{}, kPeriod_s};
  double noise_takes_s = 5.0;  ///< at rest; in motion here there is none
  double moving_noise_takes_s = 0.0;

  void For(double time_s, double unexplained_N, bool at_rest) {
    for (int i = 0; i < static_cast<int>(time_s / kPeriod_s); ++i)
      lead.Step(unexplained_N, kLevel_N, at_rest, at_rest ? noise_takes_s : moving_noise_takes_s);
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

// Behind a coarse encoder, whose every count the drive answers: a third of the level went into the wind-up.
TEST(CascadeLead, InMotionNoiseIsAveragedUntilItIsOfNoAccount) {
  Leading l;
  CascadeLead::Tuning averages;
  averages.averages_noise = true;
  l.lead = CascadeLead(averages, kPeriod_s);
  l.moving_noise_takes_s = 20.0;
  double most_N = 0.0;
  for (int i = 0; i < 400; ++i) {
    l.For(0.012, i % 2 == 0 ? 3.0 * kLevel_N : -3.0 * kLevel_N, false);
    most_N = std::max(most_N, std::abs(l.lead.lead_N()));
  }
  EXPECT_LT(most_N, 0.01 * kLevel_N);
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
