#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/motion_rig.h"

namespace contour {
namespace {

MonitoredAxis InCascade() {
  MonitoredAxis axis = Axis();
  axis.in_cascade = true;
  return axis;
}

// A motor that has wound its screw up leads the table's reference for as long as it moves: nothing slipped,
// and a reading that stands is one as soon as on a rigid axis.
TEST(MonitorOfAScrew, AMotorThatLeadsItsTableHidesNoStandingReading) {
  for (const double direction : {1.0, -1.0}) {
    const MonitoredAxis axis = InCascade();
    MotionMonitor monitor(axis, {}, kPeriod_s);
    const double path_m = monitor.thresholds().frozen.Path_m(monitor.thresholds().loop_N_m);
    const double lead_m = 10.0 * path_m;
    MotionSample s;
    s.enabled = s.fresh = true;
    s.reported_force_N = direction * axis.Fc_N;
    constexpr double kStep_m = 2e-8;
    for (int k = 0; k < 1500; ++k) {
      s.reference_m = direction * kStep_m * k;
      const double motor_m = s.reference_m + direction * lead_m * std::min(1.0, k / 500.0);
      s.position_m = axis.count_m * std::floor(motor_m / axis.count_m);
      ASSERT_EQ(monitor.Step(s), Reason::kNone) << "period " << k;
    }
    Reason reason = Reason::kNone;
    const double begin_m = s.reference_m;
    while (reason == Reason::kNone && std::abs(s.reference_m - begin_m) < lead_m) {
      s.reference_m += direction * kStep_m;
      reason = monitor.Step(s);
    }
    EXPECT_EQ(reason, Reason::kFeedbackFrozen);
    EXPECT_LT(std::abs(s.reference_m - begin_m), 2.0 * path_m);
  }
}

// A set-point that was lost: the drive's torque goes to and fro at its limit, and motor and table swing
// against each other. That is not the motion of a rigid axis, and no sign of a reversed encoder.
TEST(MonitorOfAScrew, ATorqueThatSwingsLeavesItRingingAndNothingIsReversed) {
  for (const double stiffness_N_m : {5e6, 10e6, 20e6, 40e6})
    for (const int swings : {1, 2, 3, 4}) {
      MonitoredAxis axis = InCascade();
      axis.motor_mass_kg = 50.0;
      axis.table_mass_kg = 60.0;
      axis.stiffness_N_m = stiffness_N_m;
      axis.force_limit_N = 4000.0;
      MotionMonitor monitor(axis, {}, kPeriod_s);
      double motor_m = 0.0, motor_m_s = 0.02, table_m = 0.0, table_m_s = 0.02;
      Reason reason = Reason::kNone;
      for (int k = 0; k < 60 && reason == Reason::kNone; ++k) {
        const double swing_N =
            k >= 10 && k < 10 + swings ? (k % 2 == 0 ? -1.0 : 1.0) * axis.force_limit_N : 0.0;
        MotionSample s;
        s.enabled = s.fresh = true;
        s.reference_m = 2e-5 * k;
        s.position_m = axis.count_m * std::floor(motor_m / axis.count_m);
        s.reported_force_N = axis.Fc_N + 500.0 * table_m_s + swing_N;
        reason = monitor.Step(s);
        constexpr int kSub = 100;
        constexpr double kStep_s = kPeriod_s / kSub;
        for (int i = 0; i < kSub; ++i) {
          const double screw_N = axis.stiffness_N_m * (motor_m - table_m) + 1000.0 * (motor_m_s - table_m_s);
          const double friction_N = axis.Fc_N * std::tanh(table_m_s / 1e-4) + 500.0 * table_m_s;
          motor_m_s += (s.reported_force_N - screw_N) / axis.motor_mass_kg * kStep_s;
          table_m_s += (screw_N - friction_N) / axis.table_mass_kg * kStep_s;
          motor_m += motor_m_s * kStep_s;
          table_m += table_m_s * kStep_s;
        }
      }
      EXPECT_EQ(reason, Reason::kNone) << Name(reason) << ", " << stiffness_N_m << " N/m, " << swings;
    }
}

// A torque far beyond friction moves the axis out of any band within some periods.
TEST(MonitorOfAScrew, AStrongTorqueUnderAReadingThatFlickersIsSeenWithinSomePeriods) {
  const MonitoredAxis axis = InCascade();
  MotionMonitor monitor(axis, {}, kPeriod_s);
  constexpr double kStep_m = 1e-7;
  MotionSample s;
  s.enabled = s.fresh = true;
  s.reported_force_N = axis.Fc_N;
  for (int k = 0; k < 500; ++k) {
    s.reference_m = kStep_m * k;
    s.position_m = axis.count_m * std::floor(s.reference_m / axis.count_m);
    ASSERT_EQ(monitor.Step(s), Reason::kNone) << "period " << k;
  }
  const double stands_m = s.position_m;
  std::uint32_t periods = 0;
  Reason reason = Reason::kNone;
  while (reason == Reason::kNone && periods < 100) {
    s.reference_m += kStep_m;
    s.position_m = stands_m + ++periods % 2 * axis.count_m;
    s.reported_force_N = 3.0 * monitor.thresholds().flickering_force_N;
    reason = monitor.Step(s);
  }
  EXPECT_EQ(reason, Reason::kFeedbackFrozen);
  EXPECT_LE(periods, 6u);
  EXPECT_LT(6u, monitor.thresholds().loop_periods) << "the path shows it as soon";
}

}  // namespace
}  // namespace contour
