#include "config/motion_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/load_machine.h"
#include "config/stated_push.h"
#include "control/motion_thresholds.h"
#include "core/mechanics.h"

namespace contour {
namespace {

MachineConfig Machine(DriveMode mode) {
  MachineConfig machine = LoadMachine(SOURCE_DIR "/config/family/slow40.yaml");
  for (auto& [name, axis] : machine.axes) axis.drive.mode = mode;
  return machine;
}

double Departure_mm(const MachineConfig& machine, MotionFault fault, double feed_mm_s) {
  return BoundOf(machine, machine.axes.begin()->second, fault, feed_mm_s).departure_mm;
}

double Seen_s(const MachineConfig& machine, double feed_mm_s) {
  return BoundOf(machine, machine.axes.begin()->second, MotionFault::kFrozen, feed_mm_s).time_s;
}

// The monitors go by the slowest of the loops that act, not by the stiffness of a controller that does not.
TEST(MotionBounds, AStandingReadingIsPromisedByTheLoopInUse) {
  constexpr double kCreep_mm_s = 0.02;
  MachineConfig machine = Machine(DriveMode::kCst);
  const double as_tuned_s = Seen_s(machine, kCreep_mm_s);
  machine.control.full.contour_bandwidth_Hz *= 2.0;
  machine.control.full.lag_bandwidth_Hz *= 2.0;
  EXPECT_DOUBLE_EQ(Seen_s(machine, kCreep_mm_s), as_tuned_s);
  // One soft loop is enough.
  machine.axes.rbegin()->second.loop->regulator_Hz *= 0.5;
  EXPECT_GT(Seen_s(machine, kCreep_mm_s), 2.0 * as_tuned_s);
  // In csp the drives' loops act.
  machine = Machine(DriveMode::kCsp);
  const double in_csp_s = Seen_s(machine, kCreep_mm_s);
  machine.axes.rbegin()->second.loop->regulator_Hz *= 0.5;
  EXPECT_DOUBLE_EQ(Seen_s(machine, kCreep_mm_s), in_csp_s);
  machine.control.monitor.drive_loop_Hz *= 0.5;
  EXPECT_GT(Seen_s(machine, kCreep_mm_s), in_csp_s);
}

// From the last point that was commanded, a period before the reading that jumps is seen, to no torque: one
// period to the frame, one for the drive's delay, the time in which its current fades.
TEST(MotionBounds, AJumpInMotionCountsFromTheLastCommandedPoint) {
  for (const DriveMode mode : {DriveMode::kCst, DriveMode::kCsp}) {
    const MachineConfig machine = Machine(mode);
    const AxisConfig& axis = machine.axes.begin()->second;
    const double period_s = 1e-6 * machine.machine.cycle_us;
    const double until_off_s = (2.0 + axis.drive.delay_cycles) * period_s + 3e-3 * axis.drive.lag_ms;
    const double at_rest_mm = Departure_mm(machine, MotionFault::kJump, 0.0);
    EXPECT_NEAR(Departure_mm(machine, MotionFault::kJump, 500.0) - at_rest_mm, 500.0 * until_off_s, 1e-6);
  }
}

// Downwards the minus level holds; what pushes down is taken off it, and where nothing is left the axis
// falls once it moves; beyond break-away friction it falls from rest.
TEST(MotionBounds, AnAxisWithoutVoltageCoastsAgainstItsWeightOrFalls) {
  MachineConfig machine = Machine(DriveMode::kCst);
  AxisConfig& axis = machine.axes.begin()->second;
  const double radius_m_rad = ToSi(axis.model.mechanics).radius_m_rad;
  FrictionConfig& f = axis.model.friction;
  ASSERT_EQ(f.acts_on, FrictionSide::kTable);
  const double free_mm = CoastTravel_mm(axis);
  f.Fc_plus_N = 2.0 * f.Fc_minus_N;
  f.Fs_plus_N = 2.0 * f.Fc_plus_N;
  f.Fs_minus_N = 1.5 * f.Fc_minus_N;
  const auto weighs = [&](double of_friction) {
    axis.model.extensions.constant_torque =
        ConstantTorqueExtension{-of_friction * f.Fc_minus_N * radius_m_rad};
  };
  weighs(0.0);
  const double level_mm = CoastTravel_mm(axis);
  EXPECT_LT(level_mm, 2.0 * free_mm);
  weighs(0.5);
  EXPECT_NEAR(CoastTravel_mm(axis), 2.0 * level_mm, 1e-9 * level_mm);
  for (const double of_friction : {1.1, 1.4, 1.6}) {
    weighs(of_friction);
    EXPECT_EQ(CoastTravel_mm(axis), std::numeric_limits<double>::infinity());
    EXPECT_EQ(UnbornePushOf(axis.model).at_rest_N > 0.0, of_friction > 1.5) << of_friction;
  }
}

// It counts with whatever else acts until the torque is off; what friction bears does not.
TEST(MotionBounds, AWeightBeyondFrictionTakesTheAxisFurther) {
  MachineConfig machine = Machine(DriveMode::kCst);
  AxisConfig& axis = machine.axes.begin()->second;
  const double radius_m_rad = ToSi(axis.model.mechanics).radius_m_rad;
  const double friction_N = axis.model.friction.Fc_minus_N, following_mm = axis.limits.following_error_mm;
  const MachineConfig free = machine;
  axis.model.extensions.constant_torque = ConstantTorqueExtension{-0.9 * friction_N * radius_m_rad};
  for (const MotionFault fault : kMotionFaults)
    for (const double feed_mm_s : {0.0, 1.0, 100.0})
      EXPECT_DOUBLE_EQ(Departure_mm(machine, fault, feed_mm_s), Departure_mm(free, fault, feed_mm_s));
  axis.model.extensions.constant_torque = ConstantTorqueExtension{-5.0 * friction_N * radius_m_rad};
  for (const MotionFault fault :
       {MotionFault::kJump, MotionFault::kReversed, MotionFault::kTorqueLost, MotionFault::kNotFollowing})
    EXPECT_GT(Departure_mm(machine, fault, 0.0), Departure_mm(free, fault, 0.0)) << Name(fault);
  // From rest it falls: by the following error, and on at the speed that it has by then.
  const FaultBound falls = BoundOf(machine, axis, MotionFault::kTorqueLost, 0.0);
  const double fall_m_s2 = 4.0 * friction_N / ToSi(axis.model.mechanics).mass_kg;
  EXPECT_GT(falls.time_s, std::sqrt(2e-3 * following_mm / fall_m_s2));
  EXPECT_GT(falls.departure_mm, following_mm);
  EXPECT_LT(falls.departure_mm, 3.0 * following_mm);
  // Along a path downwards it is faster than the path by as much.
  EXPECT_NEAR(Departure_mm(machine, MotionFault::kTorqueLost, 100.0) - falls.departure_mm,
              Departure_mm(free, MotionFault::kTorqueLost, 100.0) - following_mm, 1e-9);
}

// 40 N stop 84 kg from 100 mm/s in 0.2 s: the following error of a few millimetres shows long before.
TEST(MotionBounds, AnAxisWithoutTorqueCoastsAlongItsPath) {
  MachineConfig machine = Machine(DriveMode::kCst);
  AxisConfig& axis = machine.axes.begin()->second;
  const double mass_kg = ToSi(axis.model.mechanics).mass_kg;
  const double brakes_m_s2 =
      std::min(axis.model.friction.Fc_plus_N, axis.model.friction.Fc_minus_N) / mass_kg;
  const double shows_s = std::sqrt(2e-3 * axis.limits.following_error_mm / brakes_m_s2);
  ASSERT_LT(shows_s, 0.1 / brakes_m_s2);
  EXPECT_GT(BoundOf(machine, axis, MotionFault::kTorqueLost, 100.0).time_s, shows_s);
  EXPECT_LT(BoundOf(machine, axis, MotionFault::kTorqueLost, 100.0).time_s, 1.6 * shows_s);
}

// A sign that changes right after a sample shows in the second one that follows.
TEST(MotionBounds, WhatShowsAtOnceMayMissTheFirstSample) {
  constexpr double kFast_mm_s = 500.0;
  const MachineConfig machine = Machine(DriveMode::kCst);
  const AxisConfig& axis = machine.axes.begin()->second;
  const double period_s = 1e-6 * machine.machine.cycle_us;
  const double jump_s = BoundOf(machine, axis, MotionFault::kJump, kFast_mm_s).time_s;
  EXPECT_NEAR(BoundOf(machine, axis, MotionFault::kReversed, kFast_mm_s).time_s - jump_s, 2.0 * period_s,
              1e-9);
  // Our own loops answer no sooner than they have a sample; a drive's does.
  EXPECT_DOUBLE_EQ(Departure_mm(machine, MotionFault::kReversed, kFast_mm_s),
                   Departure_mm(machine, MotionFault::kJump, kFast_mm_s));
  const MachineConfig in_csp = Machine(DriveMode::kCsp);
  EXPECT_GT(Departure_mm(in_csp, MotionFault::kReversed, kFast_mm_s),
            Departure_mm(in_csp, MotionFault::kJump, kFast_mm_s));
}

}  // namespace
}  // namespace contour
