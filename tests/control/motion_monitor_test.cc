#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "tests/control/motion_rig.h"

namespace contour {
namespace {

class AtFeed : public ::testing::TestWithParam<double> {};

TEST_P(AtFeed, AFrozenEncoderIsSeenWithinAFractionOfAMillimetre) {
  const double speed_m_s = 1e-3 * GetParam();
  Rig rig;
  rig.RunUp(speed_m_s);
  const double stands_m = rig.position_m();
  rig.tells = [=](double) { return stands_m; };
  int periods = 0;
  double away_m = 0.0;
  EXPECT_EQ(rig.Until(speed_m_s, 2000, periods, away_m), Reason::kFeedbackFrozen);
  EXPECT_LT(away_m, 0.2e-3);
}

TEST_P(AtFeed, AFrozenEncoderThatFlickersIsSeen) {
  const double speed_m_s = 1e-3 * GetParam();
  Rig rig;
  rig.RunUp(speed_m_s);
  const double stands_m = rig.position_m();
  int flick = 0;
  rig.tells = [&](double) { return stands_m + (++flick % 2) * Axis().count_m; };
  int periods = 0;
  double away_m = 0.0;
  EXPECT_EQ(rig.Until(speed_m_s, 2000, periods, away_m), Reason::kFeedbackFrozen);
  EXPECT_LT(away_m, 0.5e-3);
}

TEST_P(AtFeed, AReversedEncoderIsSeenBeforeTheAxisHasGoneFar) {
  const double speed_m_s = 1e-3 * GetParam();
  Rig rig;
  rig.RunUp(speed_m_s);
  const double pivot_m = rig.position_m();
  rig.tells = [=](double p) { return 2.0 * pivot_m - p; };
  int periods = 0;
  double away_m = 0.0;
  const Reason reason = rig.Until(speed_m_s, 2000, periods, away_m);
  EXPECT_TRUE(reason == Reason::kFeedbackReversed || reason == Reason::kFeedbackJump) << Name(reason);
  EXPECT_LT(away_m, 0.5e-3);
}

TEST_P(AtFeed, LostTorqueIsSeen) {
  const double speed_m_s = 1e-3 * GetParam();
  Rig rig;
  rig.RunUp(speed_m_s);
  rig.torque_share = 0.0;
  int periods = 0;
  double away_m = 0.0;
  const Reason reason = rig.Until(speed_m_s, 60000, periods, away_m);
  EXPECT_TRUE(reason == Reason::kTorqueNotDelivered || reason == Reason::kTorqueWithoutMotion)
      << Name(reason);
}

TEST_P(AtFeed, LostTorqueIsSeenWhateverTheDriveReports) {
  const double speed_m_s = 1e-3 * GetParam();
  Rig rig;
  rig.reports = false;
  rig.RunUp(speed_m_s);
  rig.torque_share = 0.0;
  int periods = 0;
  double away_m = 0.0;
  const Reason reason = rig.Until(speed_m_s, 60000, periods, away_m);
  EXPECT_TRUE(reason == Reason::kTorqueWithoutMotion || reason == Reason::kFeedbackFrozen) << Name(reason);
}

TEST_P(AtFeed, AJumpIsSeenInTheReadingThatJumps) {
  const double speed_m_s = 1e-3 * GetParam();
  for (const double jump_m : {0.2e-3, -0.2e-3}) {
    Rig rig;
    rig.RunUp(speed_m_s);
    rig.tells = [=](double p) { return p + jump_m; };
    EXPECT_EQ(rig.Step(speed_m_s), Reason::kFeedbackJump);
  }
}

INSTANTIATE_TEST_SUITE_P(Feeds, AtFeed, ::testing::Values(0.01, 0.03, 0.1, 0.2, 1.0, 5.0, 20.0, 100.0));

TEST(MotionMonitor, SayThatTheTorqueConstantHasChanged) {
  Rig rig;
  const auto run = [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      const double speed_m_s = 0.1 * std::sin(2.0 * 3.14159 * 1.5 * 1e-3 * i);
      ASSERT_EQ(rig.Step(speed_m_s), Reason::kNone);
    }
  };
  rig.reports = false;
  run(0, 4000);
  EXPECT_FALSE(rig.monitor().torque_constant_changed()) << rig.monitor().torque_ratio();
  rig.torque_share = 0.5;
  run(4000, 14000);
  EXPECT_TRUE(rig.monitor().torque_constant_changed()) << rig.monitor().torque_ratio();
  EXPECT_NEAR(rig.monitor().torque_ratio(), 2.0, 0.3);
}

TEST(MotionMonitor, AReadingThatComesOfALateSyncIsNotBelievedAndNotAFault) {
  MonitoredAxis axis = Axis();
  axis.sample_jitter_s = 135e-6;
  Rig rig(axis);
  rig.RunUp(0.2);
  rig.tells = [](double p) { return p + 0.2 * 135e-6; };
  EXPECT_EQ(rig.Step(0.2), Reason::kNone);
  EXPECT_FALSE(rig.monitor().believed());
}

TEST(MotionMonitor, ScaleAndMotorApartByMoreThanWindUp) {
  MonitoredAxis axis = Axis();
  MotionMonitor monitor(axis, {}, kPeriod_s);
  MotionSample s;
  s.enabled = s.fresh = s.has_scale = true;
  s.table_position_m = 0.3;  // counted from elsewhere
  EXPECT_EQ(monitor.Step(s), Reason::kNone);
  s.table_position_m += 0.9 * monitor.thresholds().windup_m;
  EXPECT_EQ(monitor.Step(s), Reason::kNone);
  s.table_position_m += 0.2 * monitor.thresholds().windup_m;
  EXPECT_EQ(monitor.Step(s), Reason::kNone) << "a single message may be lost";
  EXPECT_EQ(monitor.Step(s), Reason::kNone);
  EXPECT_EQ(monitor.Step(s), Reason::kScaleDisagrees);
}

TEST(MotionMonitor, AnAxisThatIsNotHeldMayBeMovedByHand) {
  MotionMonitor monitor(Axis(), {}, kPeriod_s);
  MotionSample s;
  s.fresh = true;
  for (int i = 0; i < 1000; ++i) {
    s.position_m = 0.01 * std::sin(0.1 * i * i);
    EXPECT_EQ(monitor.Step(s), Reason::kNone);
  }
}

// Softer gains let the path go further before the torque is there that moves an axis at rest.
TEST(MotionMonitor, GoesByTheLoopThatActs) {
  MotionMonitor monitor(Axis(), {}, kPeriod_s);
  const MotionThresholds own = monitor.thresholds();
  monitor.UseLoop(0.5 * Axis().loop_Hz);
  EXPECT_NEAR(monitor.thresholds().loop_N_m, 0.25 * own.loop_N_m, 1e-9 * own.loop_N_m);
  EXPECT_GT(monitor.thresholds().loop_periods, own.loop_periods);
  monitor.UseLoop(Axis().loop_Hz);
  EXPECT_EQ(monitor.thresholds().loop_N_m, own.loop_N_m);
  EXPECT_EQ(monitor.thresholds().loop_periods, own.loop_periods);
}

// What is kept is what was seen: other keys hold for a state of before, too.
TEST(MotionMonitor, AStateOfBeforeKeepsNoThresholds) {
  MonitorConfig tolerant;
  tolerant.friction_factor = 10.0;
  MotionMonitor strict(Axis(), {}, kPeriod_s), other(Axis(), tolerant, kPeriod_s);
  const double friction_N = other.thresholds().friction_N;
  StateKeeper measuring;
  strict.Keep(measuring);
  std::vector<std::byte> state(measuring.used());
  StateKeeper saving = StateKeeper::Saving(state);
  strict.Keep(saving);
  StateKeeper loading = StateKeeper::Loading(state);
  other.Keep(loading);
  EXPECT_TRUE(loading.whole());
  EXPECT_EQ(other.thresholds().friction_N, friction_N);
}

// Without a reading the torque acts all the same, and the screw may still ring with it when one comes.
TEST(MotionMonitor, AForceThatActsWhileNoReadingComesCountsAfterwards) {
  const auto believed = [](bool pushed_unseen) {
    MotionMonitor monitor(Axis(), {}, kPeriod_s);
    MotionSample s;
    s.enabled = s.fresh = true;
    for (int k = 0; k < 20; ++k) EXPECT_EQ(monitor.Step(s), Reason::kNone);
    s.fresh = false;
    s.sent_force_N = pushed_unseen ? 1500.0 : 0.0;
    for (int k = 0; k < 3; ++k) monitor.Step(s);
    s.sent_force_N = 0.0;
    for (int k = 0; k < 3; ++k) monitor.Step(s);
    s.fresh = true;
    const MotionThresholds& t = monitor.thresholds();
    s.position_m = 1.1 * t.Forced_m(0.0, 0.0, kPeriod_s, 7.0, 1.0);
    monitor.Step(s);
    return monitor.believed();
  };
  EXPECT_FALSE(believed(false));
  EXPECT_TRUE(believed(true));
}

// A screw grows by a micrometre a minute while it warms; one that slips does so at once.
TEST(MotionMonitor, AScrewThatWarmsIsNoSlip) {
  MotionMonitor monitor(Axis(), {}, kPeriod_s);
  MotionSample s;
  s.enabled = s.fresh = s.has_scale = true;
  const double allowed_m = monitor.thresholds().windup_m + monitor.thresholds().reading_m;
  const double warming_m = allowed_m / (600.0 / kPeriod_s) * 0.9;
  Reason found = Reason::kNone;
  for (int k = 0; k < 2'000'000 && found == Reason::kNone; ++k) {
    s.table_position_m += warming_m;
    found = monitor.Step(s);
  }
  EXPECT_EQ(found, Reason::kNone);
  s.table_position_m += 1.2 * allowed_m;
  for (int k = 0; k < 5 && found == Reason::kNone; ++k) found = monitor.Step(s);
  EXPECT_EQ(found, Reason::kScaleDisagrees);
}

// A drive's own loop adds up what a standing reading leaves: that is no disturbance that settles.
TEST(MotionMonitor, WhatADrivesLoopMakesOfAStandingReadingDoesNotPutTheAlarmOff) {
  MonitoredAxis axis = Axis();
  axis.in_cascade = true;
  axis.external_force_N = 400.0;
  MotionMonitor monitor(axis, {}, kPeriod_s);
  MotionSample s;
  s.enabled = s.fresh = true;
  for (int k = 0; k < 300; ++k) {
    s.reference_m = 1e-8 * k;
    s.position_m = axis.count_m * std::floor(s.reference_m / axis.count_m);
    s.reported_force_N = 0.1 * k;
    ASSERT_EQ(monitor.Step(s), Reason::kNone) << "period " << k;
  }
  const double begin_m = s.reference_m;
  const double begin_N = s.reported_force_N;
  double lag_m = 0.0, added_m_s = 0.0;
  Reason reason = Reason::kNone;
  for (int k = 0; k < 2000 && reason == Reason::kNone; ++k) {
    s.reference_m += 1e-8;
    lag_m = s.reference_m - begin_m;
    added_m_s += lag_m * kPeriod_s;
    s.reported_force_N = begin_N + monitor.thresholds().loop_N_m * (lag_m + 1000.0 * added_m_s);
    reason = monitor.Step(s);
  }
  EXPECT_EQ(reason, Reason::kFeedbackFrozen);
  EXPECT_LT(s.reported_force_N - begin_N, axis.Fs_N) << "it has broken away before";
}

// The wind-up that a drive is told to lead by comes down with what is believed of friction, as fast as the
// path goes on: it rightly stands. The slow40 of the family with a 17-bit encoder was stopped by it on
// circles of 100 um, in 3 of 46 runs.
TEST(MotionMonitor, ADriveThatIsToldToStandIsNotFrozen) {
  MonitoredAxis axis = Axis();
  axis.in_cascade = true;
  for (const bool told : {false, true})
    for (const double flicker : {0.0, 1.0}) {
      MotionMonitor monitor(axis, {}, kPeriod_s);
      MotionSample s;
      s.enabled = s.fresh = true;
      s.reported_force_N = 0.5 * axis.Fc_N;
      const double far_m =
          3.0 * (flicker > 0.0 ? monitor.thresholds().flickering : monitor.thresholds().frozen)
                    .Path_m(monitor.thresholds().loop_N_m);
      Reason reason = Reason::kNone;
      for (int k = 0; k < 100; ++k) ASSERT_EQ(monitor.Step(s), Reason::kNone);
      for (int k = 0; k < 1000 && reason == Reason::kNone; ++k) {
        s.reference_m += far_m / 1000.0;
        s.lead_m = told ? 0.0 : -s.reference_m;
        s.position_m = flicker * axis.count_m * (k / 20 % 2);
        reason = monitor.Step(s);
      }
      EXPECT_EQ(reason, told ? Reason::kFeedbackFrozen : Reason::kNone) << flicker;
      // Once it is told to go on, it has to.
      for (int k = 0; k < 1000 && reason == Reason::kNone; ++k) {
        s.reference_m += far_m / 1000.0;
        s.position_m = flicker * axis.count_m * (k / 20 % 2);
        reason = monitor.Step(s);
      }
      EXPECT_EQ(reason, Reason::kFeedbackFrozen) << flicker;
    }
}

// A set-point that was lost: the drive's torque swings from one sample to the next with a mean near nothing,
// and the motor alone, on its screw, goes further than the mean would take motor and table.
TEST(MotionMonitor, ADriveThatSwingsTakesTheMotorFurtherThanItsMeanTorqueDoes) {
  MonitoredAxis axis = Axis();
  axis.in_cascade = true;
  const auto after = [&](double share, double force_N) {
    MotionMonitor monitor(axis, {}, kPeriod_s);
    const MotionThresholds& t = monitor.thresholds();
    MotionSample s;
    s.enabled = s.fresh = true;
    for (int k = 0; k < 20; ++k) EXPECT_EQ(monitor.Step(s), Reason::kNone);
    // Half of it acts, by the mean of both reports: it goes where that takes motor and table.
    s.reported_force_N = force_N;
    const double went_m = 0.5 * force_N / t.mass_kg * kPeriod_s * kPeriod_s;
    s.position_m = went_m;
    EXPECT_EQ(monitor.Step(s), Reason::kNone);
    s.reported_force_N = -force_N;
    s.position_m = 2.0 * went_m + share * t.Jump_m(went_m / kPeriod_s, force_N, kPeriod_s, 1.0, 1.0);
    return monitor.Step(s);
  };
  EXPECT_EQ(after(0.99, axis.force_limit_N), Reason::kNone);
  EXPECT_EQ(after(1.01, axis.force_limit_N), Reason::kFeedbackJump);
  EXPECT_EQ(after(0.99, 0.3 * axis.force_limit_N), Reason::kNone);
  EXPECT_EQ(after(1.01, 0.3 * axis.force_limit_N), Reason::kFeedbackJump);
}

// A sign that changes between two readings is no jump, and its momentum is forgotten before the following
// error is exceeded. No ramp may go by that encoder then.
TEST(MotionMonitor, AnEncoderThatTurnedRoundIsInDoubtAsLongAsTheAxisStrays) {
  MonitoredAxis light = Axis();
  light.motor_mass_kg = 4.2;
  light.table_mass_kg = 2.2;
  light.Fs_N = 13.5;
  light.Fc_N = 8.2;
  light.sigma0_N_m = 1.1e6;
  light.sigma2_Ns_m = 55.0;
  light.force_limit_N = 500.0;
  light.external_force_N = 50.0;
  light.count_m = 9.5e-9;
  light.sample_jitter_s = 135e-6;
  constexpr double kSpeed_m_s = 0.021;
  for (const bool turns : {true, false}) {
    MotionMonitor monitor(light, {}, kPeriod_s);
    MotionSample s;
    s.enabled = s.fresh = true;
    const auto step = [&](double told_m_s, double reference_m_s) {
      s.position_m += told_m_s * kPeriod_s;
      s.reference_m += reference_m_s * kPeriod_s;
      ASSERT_EQ(monitor.Step(s), Reason::kNone);
    };
    for (int k = 0; k <= 200; ++k) {
      s.sent_force_N = s.reported_force_N = std::min(8.0, 0.2 * k);
      step(kSpeed_m_s * k / 200, kSpeed_m_s * k / 200);
    }
    EXPECT_EQ(monitor.Doubt(), Reason::kNone);
    if (turns) step(0.5 * kSpeed_m_s, kSpeed_m_s);
    for (int k = 0; k < 40; ++k) step(turns ? -kSpeed_m_s : kSpeed_m_s, kSpeed_m_s);
    EXPECT_EQ(monitor.Doubt(), turns ? Reason::kFeedbackReversed : Reason::kNone);
    // It comes back.
    for (int k = 0; k <= 300; ++k) step((turns ? 0.01 * k - 1.0 : 1.0) * kSpeed_m_s, kSpeed_m_s);
    EXPECT_EQ(monitor.Doubt(), Reason::kNone);
  }
}

// Without its torque an axis may creep back a little while its loop pulls: that is not the speed which an
// encoder that turned round seems to gain.
TEST(MotionMonitor, AnAxisThatHardlyMovesUnderItsTorqueIsInDoubtAsOneWithoutTorque) {
  MotionMonitor monitor(Axis(), {}, kPeriod_s);
  MotionSample s;
  s.enabled = s.fresh = true;
  s.sent_force_N = s.reported_force_N = 350.0;
  for (int k = 0; k < 200; ++k) {
    s.position_m -= 0.001 * (1.0 + 0.001 * k) * kPeriod_s;
    ASSERT_EQ(monitor.Step(s), Reason::kNone) << "period " << k;
    if (k < 20) continue;
    ASSERT_EQ(monitor.Doubt(), Reason::kTorqueWithoutMotion) << "period " << k;
  }
}

// The reading before was another one, of an axis without torque: it stands where it jumped to.
TEST(MotionMonitor, AJumpJustBeforeTheTorqueIsNoFrozenReading) {
  MotionMonitor monitor(Axis(), {}, kPeriod_s);
  MotionSample s;
  s.fresh = true;
  for (int k = 0; k < 5; ++k) EXPECT_EQ(monitor.Step(s), Reason::kNone);
  s.position_m = s.reference_m = 0.2e-3;
  EXPECT_EQ(monitor.Step(s), Reason::kNone);
  s.enabled = true;
  EXPECT_EQ(monitor.Step(s), Reason::kFeedbackJump);
}

// As long as the report of the torque was none, nobody knows which of the two it is.
TEST(MotionMonitor, AStandingReadingUnderATorqueThatWasNeverReportedMayBeEither) {
  for (const bool reports : {false, true}) {
    MotionMonitor monitor(Axis(), {}, kPeriod_s);
    MotionSample s;
    s.enabled = s.fresh = true;
    Reason reason = Reason::kNone;
    for (int k = 0; k < 2000 && reason == Reason::kNone; ++k) {
      s.reference_m += 1e-8;
      s.sent_force_N = 10.0 * k;
      s.reported_force_N = reports ? s.sent_force_N : 0.0;
      reason = monitor.Step(s);
    }
    EXPECT_EQ(reason, reports ? Reason::kFeedbackFrozen : Reason::kTorqueWithoutMotion);
  }
}

// A drive's own torque goes through zero where the axis turns; that is no torque which is not delivered.
TEST(MotionMonitor, ATorqueThatGoesThroughZeroIsNotTakenForNone) {
  MonitoredAxis axis = Axis();
  axis.in_cascade = true;
  MotionMonitor monitor(axis, {}, kPeriod_s);
  MotionSample s;
  s.enabled = s.fresh = true;
  s.reported_force_N = 45.0;
  for (int k = 0; k < 200; ++k) {
    s.position_m = s.reference_m = 1e-7 * k;
    ASSERT_EQ(monitor.Step(s), Reason::kNone);
  }
  Reason reason = Reason::kNone;
  s.reported_force_N = 0.0;
  for (int k = 0; k < 2000 && reason == Reason::kNone; ++k) {
    s.reference_m -= 1e-8;
    reason = monitor.Step(s);
  }
  EXPECT_EQ(reason, Reason::kTorqueWithoutMotion);
}

// What slipped ahead at break-away stands until its path has come up with it.
TEST(MotionMonitor, AnAxisAheadOfItsPathIsWaitedFor) {
  MonitoredAxis axis = Axis();
  axis.in_cascade = true;
  MotionMonitor monitor(axis, {}, kPeriod_s);
  const double path_m = monitor.thresholds().frozen.Path_m(monitor.thresholds().loop_N_m);
  MotionSample s;
  s.enabled = s.fresh = true;
  s.reported_force_N = 45.0;
  for (int k = 0; s.position_m < s.reference_m + 6.0 * path_m; ++k) {
    s.reference_m = 1e-7 * k;
    s.position_m = axis.count_m * std::floor(3.0 * s.reference_m / axis.count_m);
    ASSERT_EQ(monitor.Step(s), Reason::kNone) << "period " << k;
  }
  for (; s.reference_m < s.position_m; s.reference_m += 1e-8) ASSERT_EQ(monitor.Step(s), Reason::kNone);
  Reason reason = Reason::kNone;
  for (; reason == Reason::kNone && s.reference_m < s.position_m + 10.0 * path_m; s.reference_m += 1e-8)
    reason = monitor.Step(s);
  EXPECT_NE(reason, Reason::kNone);
  EXPECT_LT(s.reference_m - s.position_m, 2.0 * path_m);
}

// What friction and outside forces do not explain has moved the axis, whatever flickers.
TEST(MotionMonitor, ATorqueThatGrowsUnderAReadingThatFlickersIsSeenAtRest) {
  MonitoredAxis axis = Axis();
  axis.in_cascade = true;
  MotionMonitor monitor(axis, {}, kPeriod_s);
  const double most_N = monitor.thresholds().flickering_force_N;
  MotionSample s;
  s.enabled = s.fresh = true;
  Reason reason = Reason::kNone;
  for (int k = 0; k < 20000 && reason == Reason::kNone; ++k) {
    s.position_m = k % 2 * axis.count_m;
    s.reported_force_N = 1e-4 * most_N * k;
    reason = monitor.Step(s);
  }
  EXPECT_EQ(reason, Reason::kFeedbackFrozen);
  EXPECT_LT(s.reported_force_N, 1.05 * most_N);
}

/// Seconds until the monitor speaks when `broken` begins, which it does one second after the start.
template <class Broken>
double TimeUntil(Reason expected, const MonitoredAxis& axis, double period_s, Broken&& broken) {
  MotionMonitor monitor(axis, {}, period_s);
  const int begin = static_cast<int>(std::lround(1.0 / period_s));
  for (int i = 0; i < 2 * begin; ++i) {
    MotionSample s;
    s.enabled = s.fresh = true;
    // Along at 10 mm/s, with friction.
    s.position_m = s.reference_m = 0.01 * i * period_s;
    s.sent_force_N = s.reported_force_N = 45.0;
    if (i >= begin) broken(s, (i - begin) * period_s);
    const Reason found = monitor.Step(s);
    if (found == Reason::kNone) continue;
    EXPECT_EQ(found, expected) << "at " << i;
    return (i - begin + 1) * period_s;
  }
  ADD_FAILURE() << "nothing was seen";
  return 0.0;
}

// Times that a drive's filters and messages are given are times whatever the cycle. Before: counts of
// periods, half as long at 500 us and twice as long at 2 ms.
TEST(MotionMonitor, TimesAreTheSameForEveryPeriod) {
  MonitoredAxis own = Axis();
  MonitoredAxis in_cascade = Axis();
  in_cascade.in_cascade = true;
  const auto reports_more = [](MotionSample& s, double) { s.reported_force_N = 300.0; };
  const auto idle = [](MotionSample& s, double) {
    s.reported_force_N = 0.0;
    s.reference_m += 2e-3;
  };
  const double report_s = TimeUntil(Reason::kTorqueNotDelivered, own, 1e-3, reports_more);
  const double idle_s = TimeUntil(Reason::kTorqueNotDelivered, in_cascade, 1e-3, idle);
  EXPECT_NEAR(report_s, 0.025, 0.01);
  EXPECT_NEAR(idle_s, 0.005, 0.001);
  for (const double period_s : {0.25e-3, 0.5e-3, 2e-3}) {
    EXPECT_NEAR(TimeUntil(Reason::kTorqueNotDelivered, own, period_s, reports_more), report_s, 2.5e-3)
        << period_s;
    EXPECT_NEAR(TimeUntil(Reason::kTorqueNotDelivered, in_cascade, period_s, idle), idle_s, 2e-3) << period_s;
  }
  // Messages of the scale that are lost or late are counted where cycles are long.
  EXPECT_EQ(ThresholdsOf(own, {}, 0.25e-3).scale_samples, 12u);
  EXPECT_EQ(ThresholdsOf(own, {}, 1e-3).scale_samples, 3u);
  EXPECT_EQ(ThresholdsOf(own, {}, 2e-3).scale_samples, 3u);
  EXPECT_EQ(ThresholdsOf(own, {}, 0.5e-3).force_periods, 40u);
}

}  // namespace
}  // namespace contour
