#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/control/motion_rig.h"

namespace contour {
namespace {

/// A motor, and behind a screw its table, which has the friction.
struct MotorAndTable {
  double motor_kg, table_kg, stiffness_N_m, damping_Ns_m, Fc_N, viscous_Ns_m;
  double motor_m = 0.0, motor_m_s = 0.0, table_m = 0.0, table_m_s = 0.0;
  double largest_m_s2 = 0.0;  ///< of the motor

  /// A period under a force on the motor.
  void Go(double force_N, double period_s) {
    constexpr int kSub = 100;
    const double step_s = period_s / kSub;
    for (int i = 0; i < kSub; ++i) {
      const double screw_N = stiffness_N_m * (motor_m - table_m) + damping_Ns_m * (motor_m_s - table_m_s);
      const double friction_N = Fc_N * std::tanh(table_m_s / 1e-4) + viscous_Ns_m * table_m_s;
      const double motor_m_s2 = (force_N - screw_N) / motor_kg;
      motor_m_s += motor_m_s2 * step_s;
      table_m_s += (screw_N - friction_N) / table_kg * step_s;
      motor_m += motor_m_s * step_s;
      table_m += table_m_s * step_s;
      largest_m_s2 = std::max(largest_m_s2, std::abs(motor_m_s2));
    }
  }
};

/// The axis as `monitored` states it, sliding.
MotorAndTable Sliding(const MonitoredAxis& monitored, double damping_Ns_m, double slides_m_s) {
  MotorAndTable out{monitored.motor_mass_kg, monitored.table_mass_kg, monitored.stiffness_N_m, damping_Ns_m,
                    monitored.Fc_N,          monitored.sigma2_Ns_m};
  out.motor_m_s = out.table_m_s = slides_m_s;
  return out;
}

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
      MotorAndTable moved = Sliding(axis, 1000.0, 0.02);
      moved.viscous_Ns_m = 500.0;
      Reason reason = Reason::kNone;
      for (int k = 0; k < 60 && reason == Reason::kNone; ++k) {
        const double swing_N =
            k >= 10 && k < 10 + swings ? (k % 2 == 0 ? -1.0 : 1.0) * axis.force_limit_N : 0.0;
        MotionSample s;
        s.enabled = s.fresh = true;
        s.reference_m = 2e-5 * k;
        s.position_m = axis.count_m * std::floor(moved.motor_m / axis.count_m);
        s.reported_force_N = axis.Fc_N + 500.0 * moved.table_m_s + swing_N;
        reason = monitor.Step(s);
        moved.Go(s.reported_force_N, kPeriod_s);
      }
      EXPECT_EQ(reason, Reason::kNone) << Name(reason) << ", " << stiffness_N_m << " N/m, " << swings;
    }
}

/// A table that slides behind its motor while a torque goes through their mode: what the monitor says.
/// `softer`: the screw is so many times softer than stated.
Reason ShakenThroughTheMode(bool in_cascade, double table_over_motor, double softer, double& largest_ma_N) {
  MonitoredAxis axis = Axis();
  axis.in_cascade = in_cascade;
  axis.motor_mass_kg = 177.0;
  axis.table_mass_kg = table_over_motor * axis.motor_mass_kg;
  const double stiffness_N_m = 70e6;
  axis.stiffness_N_m = softer * stiffness_N_m;
  axis.rated_force_N = 3500.0;
  axis.force_limit_N = 2.5 * axis.rated_force_N;
  axis.external_force_N = 0.25 * axis.rated_force_N;
  MotionMonitor monitor(axis, {}, kPeriod_s);
  const double reduced_kg =
      axis.motor_mass_kg * axis.table_mass_kg / (axis.motor_mass_kg + axis.table_mass_kg);
  const double mode_Hz = std::sqrt(stiffness_N_m / reduced_kg) / (2.0 * std::numbers::pi);
  const double damping_Ns_m = 0.06 * std::sqrt(stiffness_N_m * reduced_kg);
  constexpr double kSlides_m_s = 0.02, kSweep_s = 0.5;
  MotorAndTable moved = Sliding(axis, damping_Ns_m, kSlides_m_s);
  moved.stiffness_N_m = stiffness_N_m;
  double acting_N = 0.0, sent_N = 0.0;
  for (int k = 0; k < 1000; ++k) {
    MotionSample s;
    s.enabled = s.fresh = true;
    s.reference_m = kSlides_m_s * kPeriod_s * k;
    s.position_m = axis.count_m * std::floor(moved.motor_m / axis.count_m);
    s.sent_force_N = sent_N;
    s.reported_force_N = acting_N;
    if (const Reason reason = monitor.Step(s); reason != Reason::kNone) return reason;
    acting_N = sent_N;
    const double t = std::fmod(kPeriod_s * k, kSweep_s);
    const double from_Hz = 0.3 * mode_Hz, growth = (0.48 / kPeriod_s - from_Hz) / kSweep_s;
    sent_N = axis.Fc_N + axis.sigma2_Ns_m * kSlides_m_s +
             0.075 * axis.rated_force_N * std::sin(2.0 * std::numbers::pi * (from_Hz + 0.5 * growth * t) * t);
    moved.Go(acting_N, kPeriod_s);
    largest_ma_N = (axis.motor_mass_kg + axis.table_mass_kg) * moved.largest_m_s2;
  }
  return Reason::kNone;
}

// At its mode a light motor goes to and fro by many times what its torque makes of both masses, and between
// antiresonance and mode it goes against it. That is a screw, and no encoder that counts backwards.
TEST(MonitorOfAScrew, ATorqueThatGoesThroughTheModeOfAHeavyTableReversesNothing) {
  for (const bool in_cascade : {false, true})
    for (const double table_over_motor : {0.1, 0.5, 1.0, 1.75, 2.5})
      for (const double softer : {0.5, 1.0, 1.5, 2.0}) {
        double largest_ma_N = 0.0;
        const Reason reason = ShakenThroughTheMode(in_cascade, table_over_motor, softer, largest_ma_N);
        EXPECT_EQ(reason, Reason::kNone)
            << Name(reason) << (in_cascade ? ", csp" : ", cst") << ", table over motor " << table_over_motor
            << ", softer " << softer << ", m a " << largest_ma_N << " N";
      }
}

/// A table that slides behind its motor under a slow loop on its speed, and from a period on the reading
/// counts backwards: what the monitor says, and how far the motor went until then.
struct Reversal {
  Reason reason = Reason::kNone;
  double went_m = 0.0;
};
Reversal ReversedBehindAHeavyTable(double table_over_motor, double mode_Hz, double period_s,
                                   double slides_m_s) {
  MonitoredAxis axis = Axis();
  axis.motor_mass_kg = 40.0;
  axis.table_mass_kg = table_over_motor * axis.motor_mass_kg;
  const double mass_kg = axis.motor_mass_kg + axis.table_mass_kg;
  const double reduced_kg = axis.motor_mass_kg * axis.table_mass_kg / mass_kg;
  axis.stiffness_N_m = reduced_kg * std::pow(2.0 * std::numbers::pi * mode_Hz, 2);
  MotionMonitor monitor(axis, {}, period_s);
  const double damping_Ns_m = 0.06 * std::sqrt(axis.stiffness_N_m * reduced_kg);
  const double loop_Ns_m = mass_kg * 2.0 * std::numbers::pi * 0.1 * mode_Hz;
  MotorAndTable moved = Sliding(axis, damping_Ns_m, slides_m_s);
  double acting_N = 0.0, sent_N = 0.0, before_m = 0.0, turned_at_m = 0.0;
  const int turns = static_cast<int>(0.3 / period_s);
  for (int k = 0; k < 10 * turns; ++k) {
    if (k == turns) turned_at_m = moved.motor_m;
    const double seen_m = k < turns ? moved.motor_m : 2.0 * turned_at_m - moved.motor_m;
    MotionSample s;
    s.enabled = s.fresh = true;
    s.reference_m = slides_m_s * period_s * k;
    s.position_m = axis.count_m * std::floor(seen_m / axis.count_m);
    s.sent_force_N = sent_N;
    s.reported_force_N = acting_N;
    const Reason reason = monitor.Step(s);
    if (k < turns) {
      EXPECT_EQ(reason, Reason::kNone);
    }
    if (reason != Reason::kNone) return {reason, std::abs(moved.motor_m - turned_at_m)};
    acting_N = sent_N;
    const double wanted_N = axis.Fc_N + axis.sigma2_Ns_m * slides_m_s +
                            loop_Ns_m * (slides_m_s - (s.position_m - before_m) / period_s);
    if (k > 0) sent_N = std::clamp(wanted_N, -axis.force_limit_N, axis.force_limit_N);
    before_m = s.position_m;
    moved.Go(acting_N, period_s);
  }
  return {};
}

// What is allowed for the screw hides no encoder that counts backwards. The loop has a tenth of the mode's
// frequency: until momentum shows it the axis goes as far as it does within a share of the loop's period.
TEST(MonitorOfAScrew, AnEncoderThatTurnsRoundBehindAHeavyTableIsSeen) {
  for (const double period_s : {1e-3, 0.25e-3})
    for (const double mode_Hz : {40.0, 65.0, 127.0})
      for (const double table_over_motor : {0.1, 1.0, 2.5})
        for (const double slides_m_s : {1e-3, 3e-3, 10e-3, 50e-3}) {
          const Reversal r = ReversedBehindAHeavyTable(table_over_motor, mode_Hz, period_s, slides_m_s);
          const auto where = [&] {
            return std::string(Name(r.reason)) + ", " + std::to_string(1e3 * r.went_m) + " mm, mode " +
                   std::to_string(mode_Hz) + " Hz, table over motor " + std::to_string(table_over_motor) +
                   ", period " + std::to_string(period_s) + " s, " + std::to_string(slides_m_s) + " m/s";
          };
          EXPECT_TRUE(r.reason == Reason::kFeedbackReversed || r.reason == Reason::kFeedbackJump) << where();
          EXPECT_LT(r.went_m, 20e-3 * std::pow(40.0 / mode_Hz, 2) + 0.1 * slides_m_s) << where();
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
