#include "design/creep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "design/loop_margins.h"
#include "tests/design/creeping_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
// Of the light stage, found without regard to the slope.
const LoopTuning kOnLightStage{15.2, 0.241, 0.905, 165.0, 767.0, 828.0, 0.51, 0.665, 0.127, 1.0, 5.0};
const LoopTuning kOnBase{26.7, 0.12, 0.10, 274.0, 1038.0, 793.0, 0.75, 0.10, 0.06, 1.0, 5.0};
const LoopTuning kOnStiffTable{3.48, 20.0, 0.469, 7.69, 19.7, 0.667, 0.906, 1.96, 0.52, 1.0, 5.0};

const LoopTuning kOnSoftlyHeld{11.0, 0.0788, 0.0261, 134.0, 1490.0, 43.0, 0.559, 2.0, 0.442, 1.0, 5.0};

TwoInertiaLoop Loop(const LoopAxis& axis, const LoopTuning& tuning, double period_s = kPeriod_s) {
  return DesignLoop(axis.axis, tuning, period_s, false);
}

TEST(StickSlipOf, IsNoneWhereALoopBearsTheSlope) {
  const LoopAxis axis = AxisOf("base");
  const StickSlip s = StickSlipOf(axis, Loop(axis, kOnBase), kPeriod_s);
  EXPECT_FALSE(s.Sticks()) << s.swing_m << " at " << s.at_m_s;
  EXPECT_TRUE(s.ComesToRest()) << s.rest_m;
}

TEST(StickSlipOf, SaysWhereAndByHowMuchALightStageSticks) {
  const LoopAxis axis = LightStage();
  const StickSlip s = StickSlipOf(axis, Loop(axis, kOnLightStage), kPeriod_s);
  EXPECT_TRUE(s.Sticks());
  EXPECT_LT(s.fastest_m_s, 2.0 * axis.friction.vs_m_s);
  EXPECT_GT(s.swing_m, axis.friction.Fc_plus_N / axis.friction.sigma0_N_m);
  EXPECT_TRUE(s.ComesToRest()) << s.rest_m;
}

TEST(StickSlipOf, IsOfTheSlopeAlone) {
  LoopAxis axis = LightStage();
  axis.friction.Fs_plus_N = axis.friction.Fs_minus_N = axis.friction.Fc_plus_N;
  const StickSlip s = StickSlipOf(axis, Loop(axis, kOnLightStage), kPeriod_s);
  EXPECT_LT(s.swing_m, 0.1 * axis.friction.Fc_plus_N / axis.friction.sigma0_N_m);
}

TEST(StickSlipOf, SeesAnAxisThatHuntsAtRest) {
  const LoopAxis axis = StiffTable();
  const StickSlip s = StickSlipOf(axis, Loop(axis, kOnStiffTable, kSlowPeriod_s), kSlowPeriod_s);
  EXPECT_FALSE(s.ComesToRest());
  // Not by a little.
  EXPECT_GT(s.rest_m, 10.0 * s.most_rest_m);
}

// It keeps every limit of a linear axis.
TEST(RestAfterStops, SeesALoopThatOnlyHoldsHunt) {
  const LoopAxis axis = HeavyTable();
  const StickSlip s = RestAfterStops(axis, Loop(axis, kHoldsOnly), kPeriod_s);
  EXPECT_FALSE(s.ComesToRest());
  EXPECT_GT(std::max(s.rest_m / s.most_rest_m, s.stop_m / s.most_stop_m), 2.0);
  const LoopTuning takes_up{10.9, 2.1, 2.66, 54.9, 442.0, 171.0, 1.58, 0.627, 0.286, 1.0, 5.0};
  EXPECT_TRUE(RestAfterStops(axis, Loop(axis, takes_up), kPeriod_s).ComesToRest());
}

// What settles for seconds does not hunt: it is looked at once it has.
TEST(StickSlipOf, WaitsForWhatSettlesSlowly) {
  const LoopAxis axis = SoftlyHeld();
  const TwoInertiaLoop loop = Loop(axis, kOnSoftlyHeld);
  const double growth = GrowthOn(RestingMember(axis), loop, kPeriod_s);
  ASSERT_LT(growth, 1.0);
  ASSERT_GT(growth, 0.999);
  const CreepTimes times = TimesOf(axis, loop, kPeriod_s, axis.friction.vs_m_s);
  EXPECT_LT(std::pow(growth, times.rests_s / kPeriod_s), 0.01);
  const StickSlip s = StickSlipOf(axis, loop, kPeriod_s);
  EXPECT_TRUE(s.Sticks());
  EXPECT_TRUE(s.ComesToRest()) << s.rest_m << " of " << s.most_rest_m;
}

TEST(TimesOf, AreThoseOfTheAxis) {
  const LoopAxis axis = LightStage();
  const TwoInertiaLoop loop = Loop(axis, kOnLightStage);
  const double vs_m_s = axis.friction.vs_m_s;
  const CreepTimes slow = TimesOf(axis, loop, kPeriod_s, 0.1 * vs_m_s);
  const CreepTimes fast = TimesOf(axis, loop, kPeriod_s, 10.0 * vs_m_s);
  // Bristles take longer to bend at a lower speed; how the axis stops is the same.
  EXPECT_GT(slow.looks_creeping_s, fast.looks_creeping_s);
  EXPECT_GT(slow.creeps_s, slow.looks_creeping_s);
  EXPECT_EQ(slow.rests_s, fast.rests_s);
  // A softer loop settles later.
  LoopTuning softer = kOnLightStage;
  softer.regulator_Hz *= 0.5;
  softer.disturbance_Hz *= 0.5;
  EXPECT_GT(TimesOf(axis, Loop(axis, softer), kPeriod_s, 10.0 * vs_m_s).creeps_s, fast.creeps_s);
  EXPECT_GT(TimesOf(axis, Loop(axis, softer), kPeriod_s, 10.0 * vs_m_s).rests_s, fast.rests_s);
}

// Bristles much stiffer than the screw swing the table far quicker than its mode: steps go by what is
// quickest.
TEST(CreepAt, FollowsBristlesStifferThanTheScrew) {
  LoopAxis axis = LightStage();
  const TwoInertiaLoop loop = Loop(axis, kOnLightStage);
  axis.friction.sigma0_N_m *= 400.0;
  axis.friction.sigma1_Ns_m *= 20.0;
  axis.friction.Fs_plus_N = axis.friction.Fs_minus_N = axis.friction.Fc_plus_N;
  const double speed_m_s = axis.friction.vs_m_s;
  EXPECT_LT(CreepAt(axis, loop, kPeriod_s, speed_m_s).swing_m, 1e-6);
}

TEST(CreepAt, HasNoMoreForceThanTheTorqueLimitLeaves) {
  LoopAxis axis = LightStage();
  const TwoInertiaLoop loop = Loop(axis, kOnLightStage);
  const double speed_m_s = axis.friction.vs_m_s;
  const double free_m = CreepAt(axis, loop, kPeriod_s, speed_m_s).swing_m;
  axis.most_force_N = 0.5 * axis.friction.Fc_plus_N;
  EXPECT_GT(CreepAt(axis, loop, kPeriod_s, speed_m_s).swing_m, 10.0 * free_m);
}

TEST(CreepAt, IsWhatTheLinearLoopSaysAboutOneSpeed) {
  // Fast enough for the slope to have faded, a steady speed is steady.
  const LoopAxis axis = LightStage();
  const TwoInertiaLoop loop = Loop(axis, kOnLightStage);
  const Creep fast = CreepAt(axis, loop, kPeriod_s, 10.0 * axis.friction.vs_m_s);
  EXPECT_LT(fast.swing_m, 1e-8);
  const Creep slow = CreepAt(axis, loop, kPeriod_s, axis.friction.vs_m_s);
  EXPECT_GT(slow.swing_m, 1e-6);
  // An unstable loop does not settle at any.
  LoopTuning wild = kOnLightStage;
  wild.regulator_Hz = 80.0;
  EXPECT_GT(CreepAt(axis, Loop(axis, wild), kPeriod_s, 10.0 * axis.friction.vs_m_s).swing_m, 1e-4);
}

TEST(CreepAt, HasTheDelayOfTheAxis) {
  // A cycle late is more than this loop bears.
  LoopAxis axis = LightStage();
  const TwoInertiaLoop loop = Loop(axis, kOnLightStage);
  const double speed_m_s = 10.0 * axis.friction.vs_m_s;
  const double prompt_m = CreepAt(axis, loop, kPeriod_s, speed_m_s).swing_m;
  axis.axis.dead_time_s = 3.5 * kPeriod_s;
  EXPECT_GT(CreepAt(axis, loop, kPeriod_s, speed_m_s).swing_m, 100.0 * prompt_m + 1e-6);
}

}  // namespace
}  // namespace contour
