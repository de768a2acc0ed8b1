#include "config/machine_checks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "config/load_machine.h"
#include "config/mode_advice.h"
#include "config/stopping.h"
#include "core/mechanics.h"
#include "tests/config/test_files.h"

namespace contour {
namespace {

MachineConfig Good() { return LoadMachine(ExampleMachine("xy_emulated.yaml")); }

// The one problem of a machine, as "key: message".
std::string Only(const MachineConfig& c) {
  const std::vector<ConfigProblem> problems = Check(c);
  std::string all;
  for (const ConfigProblem& p : problems) all += (all.empty() ? "" : "\n") + p.key + ": " + p.message;
  EXPECT_EQ(problems.size(), 1U) << all;
  return all;
}

TEST(MachineChecks, TheExampleIsSound) { EXPECT_TRUE(Check(Good()).empty()); }

TEST(MachineChecks, Nodes) {
  MachineConfig c = Good();
  c.axes.at("y").drive.node_id = 1;
  EXPECT_EQ(Only(c),
            "axes.y.drive.node_id: duplicate node: found 1, already the node of axis 'x' on bus 'main'");
  c.buses["second"].interface = "loopback";
  c.axes.at("y").drive.bus = "second";
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("y").drive.node_id = 127;
  EXPECT_EQ(
      Only(c),
      "axes.y.drive.node_id: found 127, which is the master's own node on bus 'second' (master_node_id)");
}

// 2^31 counts to either side are 640 mm at 2^24 counts a turn of 5 mm.
TEST(MachineChecks, AnAbsoluteCountThatWrapsWithinTheStrokeIsRefused) {
  MachineConfig c = Good();
  AxisConfig& x = c.axes.at("x");
  const double most_mm = 2147483647.0 / x.drive.encoder_counts_per_rev * x.model.mechanics.lead_mm;
  ASSERT_GT(most_mm, 2000.0);
  x.limits.position_mm = {-200.0, most_mm - x.limits.safe_travel_mm - 1.0};
  EXPECT_TRUE(Check(c).empty());
  x.limits.position_mm[1] += 2.0;
  const std::string text = Only(c);
  EXPECT_NE(text.find("axes.x.limits.position_mm: found a range that goes, with safe_travel_mm, to "),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("0x6064"), std::string::npos) << text;
  x.limits.position_mm = {-x.limits.position_mm[1], 200.0};
  EXPECT_FALSE(Check(c).empty()) << "to the other side";
  x.drive.absolute_encoder = false;
  EXPECT_TRUE(Check(c).empty()) << "an incremental count is continued over its wrap";
}

TEST(MachineChecks, LearningNeedsAScaleOnEveryAxis) {
  MachineConfig c = Good();
  c.learning.enabled = true;
  for (const char* axis : {"x", "y"}) c.axes.at(axis).drive.linear_scale.emplace().counts_per_mm = 10000;
  c.buses["second"].interface = "loopback";
  c.axes.at("y").drive.bus = "second";
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("y").drive.linear_scale.reset();
  EXPECT_EQ(
      Only(c),
      "axes.y.drive.linear_scale: found none, but learning.enabled is true; expected a scale on every axis");
}

TEST(MachineChecks, ALoopWithAScaleNeedsOneAndNumbersThatGiveALoop) {
  MachineConfig c = Good();
  c.control.friction = FrictionKind::kLinear;
  const LoopTuning loop{20.0, 0.4, 0.18, 200.0, 400.0, 400.0, 0.77, 0.7, 0.3};
  for (const char* axis : {"x", "y"}) c.axes.at(axis).loop = loop;
  c.axes.at("x").scale_loop = loop;
  EXPECT_EQ(
      Only(c),
      "axes.x.scale_loop: found a tuning with a linear scale in the loop, but the drive has none; expected "
      "drive.linear_scale, or no scale_loop");
  c.axes.at("x").drive.linear_scale.emplace().counts_per_mm = 10000;
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("x").scale_loop->bias_Hz = 0.0;
  EXPECT_EQ(Only(c),
            "axes.x.scale_loop: found a tuning that gives no loop: bias_Hz: expected a positive number");
}

// A loop that is missing is no fault of the file: one is chosen at start (design/loop_choice.h).
TEST(MachineChecks, ALoopInTorqueModeMustBeOne) {
  MachineConfig c = Good();
  c.control.friction = FrictionKind::kLinear;
  const LoopTuning loop{20.0, 0.4, 0.18, 200.0, 400.0, 400.0, 0.77, 0.7, 0.3};
  c.axes.at("x").loop = loop;
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("y").loop = loop;
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("y").loop->disturbance_Hz = -1.0;
  EXPECT_EQ(Only(c),
            "axes.y.loop: found a tuning that gives no loop: disturbance_Hz: expected a positive number");
  for (const char* axis : {"x", "y"}) c.axes.at(axis).loop.reset();
  for (const char* axis : {"x", "y"}) c.axes.at(axis).drive.mode = DriveMode::kCsp;
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("x").drive.mode = c.axes.at("y").drive.mode = DriveMode::kCst;
  c.machine.controller = ControllerName::kMpcSrukf7;
  EXPECT_TRUE(Check(c).empty());
}

TEST(MachineChecks, Buses) {
  MachineConfig c = Good();
  c.axes.at("x").drive.bus = "mian";
  EXPECT_EQ(Only(c), "axes.x.drive.bus: found 'mian', expected a bus of this file: main");
  c = Good();
  c.buses["main"].interface = "can0";
  c.buses["other"].interface = "can0";
  c.axes.at("y").drive.bus = "other";
  EXPECT_EQ(
      Only(c),
      "buses.other.interface: found 'can0', already the interface of bus 'main'; each bus needs its own");
  c = Good();
  c.buses["main"].interface = "a_name_longer_than_15";
  EXPECT_NE(Only(c).find("longer than a Linux interface name"), std::string::npos);
}

TEST(MachineChecks, Timing) {
  MachineConfig c = Good();
  c.realtime.send_deadline_us = 1000;
  EXPECT_EQ(Only(c), "realtime.send_deadline_us: found 1000, expected less than the cycle of 1000 us");
  c = Good();
  c.machine.cycle_us = 1234;
  EXPECT_EQ(Only(c).substr(0, 16), "machine.cycle_us");
}

// Torque is not turned round by 0x607E: position or velocity alone against it is positive feedback.
TEST(MachineChecks, PolarityOfPositionAndVelocityIsOne) {
  MachineConfig c = Good();
  for (const int polarity : {1, 64, 128, 193}) {
    c.axes.at("x").drive.polarity = polarity;
    EXPECT_EQ(Only(c), "axes.x.drive.polarity: found " + std::to_string(polarity) +
                           ", expected 0, or 192: bits 7 (position) and 6 (velocity) of 0x607E together, "
                           "no other");
  }
  c.axes.at("x").drive.polarity = 192;
  c.axes.at("x").drive.mode = DriveMode::kCst;
  EXPECT_EQ(Only(c).substr(0, 65), "axes.x.drive.polarity: found 192 in torque mode (cst), expected 0");
  c.axes.at("x").drive.mode = DriveMode::kCsp;
  for (const ConfigProblem& p : Check(c)) EXPECT_NE(p.key, "axes.x.drive.polarity");
}

TEST(MachineChecks, Torques) {
  MachineConfig c = Good();
  c.axes.at("x").limits.torque_Nm = 1.95;
  c.axes.at("x").limits.safe_travel_mm = 3;
  EXPECT_EQ(Only(c), "axes.x.limits.torque_Nm: found 1.95, more than the drive's peak_torque_Nm of 1.91");
  c = Good();
  c.axes.at("x").drive.rated_torque_Nm = 0.04;
  EXPECT_EQ(Only(c),
            "axes.x.limits.torque_Nm: found 1.5, expected at most 1.311, the most a target torque (0x6071) "
            "can carry at "
            "this rated torque");
}

TEST(MachineChecks, EmptyPositionRange) {
  MachineConfig c = Good();
  c.axes.at("x").limits.position_mm = {200.0, -200.0};
  EXPECT_EQ(Only(c),
            "axes.x.limits.position_mm: found an empty range, 200 to -200, expected the lower end first");
}

TEST(MachineChecks, ImpossibleAccelerationSaysWhatIsAvailable) {
  MachineConfig c = Good();
  AxisConfig& x = c.axes.at("x");
  // Reckoned by hand for the example: R = 5 mm / 2 pi, m = 4.65e-5 / R^2 + 10.6 = 84.03 kg, friction 40.5 N +
  // 440 * 0.25 N. Torque for 30 m/s^2: R (84.03 * 30 + 150.5) = 2.126 Nm; with 1.5 Nm there are (1885 -
  // 150.5) / 84.03 = 20.64 m/s^2.
  x.limits.acceleration_mm_s2 = 30000;
  EXPECT_EQ(Only(c),
            "axes.x.limits.acceleration_mm_s2: impossible limit: found 30000, which takes 2.126 Nm at 250 "
            "mm/s against "
            "friction; the torque limit of 1.5 Nm leaves 20641 mm/s^2");
}

TEST(MachineChecks, JerkAgainstTorqueRate) {
  MachineConfig c = Good();
  c.axes.at("x").limits.torque_rate_Nm_s = 10.0;
  // R m j = 0.7958e-3 * 84.03 * 200 = 13.37 Nm/s.
  EXPECT_EQ(Only(c),
            "axes.x.limits.jerk_mm_s3: impossible limit: found 200000, which takes 13.37 Nm/s; "
            "torque_rate_Nm_s is 10");
}

TEST(MachineChecks, TravelBeforeADeadMasterIsNoticed) {
  MachineConfig c = Good();
  c.axes.at("x").drive.notice_ms = 40;
  const std::string problem = Only(c);
  EXPECT_EQ(problem.substr(0, 51), "axes.x.limits.safe_travel_mm: found 2, but from res");
  EXPECT_NE(problem.find("notice_ms 40"), std::string::npos) << problem;
  c.axes.at("x").limits.safe_travel_mm = SilentMaster(ToStoppingAxis(c, c.axes.at("x")), 0.0).travel_mm;
  EXPECT_TRUE(Check(c).empty());
}

// A weight of 0.3 Nm on R = 0.796 mm pulls by 377 N, of which friction downwards bears 40.5 N.
TEST(MachineChecks, WhatTheModelSaysPushesTakesItsShareOfTheTorque) {
  MachineConfig c = Good();
  AxisConfig& x = c.axes.at("x");
  const AxisReserve without = Reserve(x);
  const StoppingAxis free = ToStoppingAxis(c, x);
  EXPECT_DOUBLE_EQ(free.Deceleration_m_s2(), free.ramp_m_s2);
  x.model.extensions.constant_torque = ConstantTorqueExtension{-0.3};
  const AxisReserve with = Reserve(x);
  EXPECT_NEAR(with.needed_Nm - without.needed_Nm, 0.3, 1e-9);
  EXPECT_NEAR(without.available_m_s2 - with.available_m_s2, 0.3 / (with.radius_m_rad * with.mass_kg), 1e-9);
  StoppingAxis hung = ToStoppingAxis(c, x);
  const double share_m_s2 =
      (with.pushed_N - ToSi(x.model.friction, with.radius_m_rad).Fc_minus_N) / with.mass_kg;
  EXPECT_NEAR(hung.torque_acceleration_m_s2 - free.torque_acceleration_m_s2, share_m_s2, 1e-9);
  EXPECT_NEAR(free.braking_m_s2 - hung.braking_m_s2, share_m_s2, 1e-9);

  const double travel_mm = SilentMaster(hung, 0.0).travel_mm;
  ASSERT_GT(travel_mm, x.limits.safe_travel_mm);
  const std::string problem = Only(c);
  EXPECT_TRUE(
      problem.starts_with("axes.x.limits.safe_travel_mm: found 2, but from rest at the torque limit "
                          "and the 377 N that model.extensions states, the axis goes "))
      << problem;
  x.limits.safe_travel_mm = 2.0 * travel_mm;
  EXPECT_TRUE(Check(c).empty());
  // What friction bears makes no difference.
  x.model.extensions.constant_torque = ConstantTorqueExtension{-0.03};
  EXPECT_DOUBLE_EQ(SilentMaster(ToStoppingAxis(c, x), 0.0).travel_mm, SilentMaster(free, 0.0).travel_mm);
}

// Without friction, which would help: 1885 N of the torque limit, 84 kg.
TEST(MachineChecks, AnAxisThatIsPushedStopsByWhatIsLeftOfTheTorque) {
  MachineConfig c = Good();
  AxisConfig& x = c.axes.at("x");
  x.model.extensions.constant_torque = ConstantTorqueExtension{0.6};
  const StoppingAxis s = ToStoppingAxis(c, x);
  EXPECT_LT(s.Deceleration_m_s2(), s.ramp_m_s2);
  EXPECT_NEAR(s.Deceleration_m_s2(), (1885.0 - (754.0 - 36.5)) / 84.0, 0.05);
  EXPECT_NEAR(QuickStop(s, 0.25, 0.0).travel_mm,
              250.0 * (0.5 * 0.25 / s.Deceleration_m_s2() + kRampFollowing_s), 1e-9);
}

TEST(MachineChecks, AnAxisThatCannotHoldItsWeightIsRefused) {
  MachineConfig c = Good();
  AxisConfig& x = c.axes.at("x");
  x.model.extensions.cable_spring = CableSpringExtension{0.0, {-200, 200}, {0.5, -1.2}};
  x.model.extensions.constant_torque = ConstantTorqueExtension{-0.4};
  EXPECT_TRUE(Only(c).starts_with("axes.x.limits.torque_Nm: found 1.5, expected more than 1.6: that much "))
      << Only(c);
}

TEST(MachineChecks, AnAxisThatCannotAccelerateAgainstItsWeightIsRefused) {
  MachineConfig c = Good();
  AxisConfig& x = c.axes.at("x");
  x.model.extensions.constant_torque = ConstantTorqueExtension{-1.1};
  x.limits.safe_travel_mm = 20.0;
  EXPECT_TRUE(Only(c).starts_with("axes.x.limits.acceleration_mm_s2: impossible limit: found 5000, "))
      << Only(c);
  EXPECT_NE(Only(c).find(" against friction and the 1382 N that model.extensions states; "),
            std::string::npos)
      << Only(c);
}

TEST(MachineChecks, StopsThatPromiseNothing) {
  MachineConfig c = Good();
  DriveConfig& drive = c.axes.at("x").drive;
  drive.quick_stop_deceleration_rad_s2 = 0.0;
  EXPECT_NE(Only(c).find("no stopping distance can be promised"), std::string::npos);
  drive.quick_stop_deceleration_rad_s2 = 30000.0;
  EXPECT_NE(Check(c).size(), 0U);
  drive.quick_stop_deceleration_rad_s2 = 22600.0;
  drive.abort_connection_option = 0;
  EXPECT_NE(Only(c).find("expected 3 (quick stop)"), std::string::npos);
  drive.abort_connection_option = 3;
  drive.quick_stop_option = 0;
  EXPECT_NE(Only(c).find("expected 2 (quick-stop ramp, then off)"), std::string::npos);
}

TEST(MachineChecks, ModelMustMakeSense) {
  MachineConfig c = Good();
  c.axes.at("x").model.friction.Fs_plus_N = 10.0;
  EXPECT_EQ(Only(c),
            "axes.x.model.friction.Fs_plus_N: found less than Fc_plus_N: break-away friction is never below "
            "Coulomb "
            "friction");
  c = Good();
  c.axes.at("x").model.uncertainty["colour"] = 0.1;
  EXPECT_EQ(Only(c), "axes.x.model.uncertainty.colour: found a key that is no parameter of this model");
}

TEST(MachineChecks, PartsOfTheTableThatSwingAreTwoAndLessThanTheTable) {
  MachineConfig c = Good();
  c.axes.at("x").model.side_modes = {{170.0, 0.12}, {90.0, 0.1}};
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("x").model.side_modes.push_back({250.0, 0.1});
  EXPECT_NE(Only(c).find("axes.x.model.side_modes: found 3, expected at most 2"), std::string::npos);
  c.axes.at("x").model.side_modes = {{170.0, 0.5}, {90.0, 0.5}};
  EXPECT_NE(Only(c).find("expected less than 0.9"), std::string::npos);
}

TEST(MachineChecks, ModeAndController) {
  MachineConfig c = Good();
  for (auto& [name, axis] : c.axes) axis.drive.mode = DriveMode::kCsp;
  EXPECT_TRUE(Check(c).empty()) << "full works in either mode";
  c.axes.at("y").drive.mode = DriveMode::kCst;
  c.machine.controller = ControllerName::kMpcSrukf7;
  EXPECT_EQ(Only(c),
            "axes.x.drive.mode: found csp, but machine.controller mpc_srukf7 gives torques; expected cst");
  c.machine.controller = ControllerName::kCsp;
  EXPECT_TRUE(Check(c).empty());
  c.control.csp.torque_offset = true;
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("x").drive.csp_torque_offset = false;
  EXPECT_EQ(
      Only(c),
      "axes.x.drive.csp_torque_offset: found false, but control.csp.torque_offset is true; expected true");
}

TEST(ModeAdvice, CspWithACoarseEncoderIsAdvisedAgainst) {
  MachineConfig c = Good();
  c.axes.at("x").drive.encoder_counts_per_rev = 25000;
  c.axes.at("x").model.mechanics.screw_stiffness_N_um *= 3.0;
  EXPECT_TRUE(ModeAdvice(c).empty()) << "the example works in cst";
  for (auto& [name, axis] : c.axes) axis.drive.mode = DriveMode::kCsp;
  ASSERT_EQ(ModeAdvice(c).size(), 1u) << "y has a fine one";
  EXPECT_TRUE(ModeAdvice(c).front().starts_with("axes.x.drive.mode: csp with an encoder of 25000 counts"))
      << ModeAdvice(c).front();
  EXPECT_NE(ModeAdvice(c).front().find("machine.controller: csp"), std::string::npos)
      << ModeAdvice(c).front();
  EXPECT_TRUE(Check(c).empty()) << "advice refuses nothing";
  // Behind counts that hide friction noise of the reports is averaged, but not by the filter.
  c.axes.at("x").drive.encoder_counts_per_rev = 10000;
  c.control.friction = FrictionKind::kSrukf;
  EXPECT_EQ(ModeAdvice(c).size(), 1u);
  c.control.friction = FrictionKind::kLinear;
  EXPECT_TRUE(ModeAdvice(c).empty());
  c.axes.at("x").drive.encoder_counts_per_rev = 25000;
  // A soft screw gives way by more than that anyway.
  c.axes.at("x").model.mechanics.screw_stiffness_N_um *= 0.02;
  EXPECT_TRUE(ModeAdvice(c).empty());
  c.axes.at("x").model.mechanics.screw_stiffness_N_um *= 50.0;
  c.machine.controller = ControllerName::kCsp;
  EXPECT_TRUE(ModeAdvice(c).empty()) << "csp has no other mode";
}

TEST(ModeAdvice, TheDriveIsAdvisedWhereALoopOverTheBusIsSofter) {
  const AxisConfig axis = Good().axes.at("x");
  const double screw_m_N = 1e-6 / axis.model.mechanics.screw_stiffness_N_um;
  const auto advice = AdviceForDrive("x", axis, 20.0 * screw_m_N, 1e-3);
  ASSERT_TRUE(advice);
  EXPECT_TRUE(advice->starts_with("axes.x.drive.mode: csp")) << *advice;
  EXPECT_FALSE(AdviceForDrive("x", axis, 2.0 * screw_m_N, 1e-3)) << "as stiff as the screw lets it be";
  AxisConfig coarse = axis;
  coarse.drive.encoder_counts_per_rev = 10000;
  EXPECT_FALSE(AdviceForDrive("x", coarse, 20.0 * screw_m_N, 1e-3));
}

TEST(MachineChecks, ATemperatureThatNeverChangesIsNone) {
  MachineConfig c = Good();
  c.io.modbus.emplace().inputs.screw_temperature.emplace().degC_per_count = 0.0;
  EXPECT_EQ(Only(c),
            "io.modbus.inputs.screw_temperature.degC_per_count: found 0, expected what a count is worth: the "
            "temperature would never change");
}

TEST(MachineChecks, EveryOutputHasAnAddressOfItsOwn) {
  MachineConfig c = Good();
  IoOutputsConfig& outputs = c.io.modbus.emplace().outputs;
  outputs.lubrication.emplace().coil = 3;
  outputs.program.emplace().mist = ProgramCoilConfig{3, 0.0};
  EXPECT_EQ(Only(c),
            "io.modbus.outputs.program.mist.coil: another output has this address, expected one of its own");
  outputs.program->mist->coil = 4;
  outputs.program->tool_number = ToolRegisterConfig{4};
  EXPECT_TRUE(Check(c).empty()) << "coils and registers are not the same";
  outputs.program->spindle_speed = SpeedRegisterConfig{4, 1.0, 6000.0, 0.0};
  EXPECT_NE(Check(c).empty(), true);
  outputs.program->spindle_speed = SpeedRegisterConfig{5, 10.0, 6600.0, 0.0};
  EXPECT_EQ(
      Only(c),
      "io.modbus.outputs.program.spindle_speed.largest_rpm: its counts do not fit into a register of 16 "
      "bits, expected 65535 counts at most");
}

TEST(MachineChecks, FullTakesAllAxesInOneMode) {
  MachineConfig c = Good();
  c.axes.at("y").drive.mode = DriveMode::kCsp;
  EXPECT_EQ(Only(c), "axes.y.drive.mode: found csp, but axis 'x' has cst; expected one mode for all axes");
  c.axes.at("x").drive.mode = DriveMode::kCsp;
  EXPECT_TRUE(Check(c).empty());
  c.axes.at("y").drive.csp_torque_offset = false;
  EXPECT_EQ(
      Only(c),
      "axes.y.drive.csp_torque_offset: found false, but machine.controller full sends friction as torque "
      "offset in mode csp; expected true");
}

// The axis of CANOPEN's warning: rated torque held for 100 ms gains 0.85 m/s and 42 mm.
TEST(Stopping, HeldTorqueFromRest) {
  StoppingAxis axis;
  axis.torque_acceleration_m_s2 = 8.5;
  axis.ramp_m_s2 = axis.braking_m_s2 = 10.0;
  axis.notice_s = 0.1 - kWatchdogStep_s;
  const StopBound b = SilentMaster(axis, 0.0);
  EXPECT_NEAR(b.travel_mm, 42.5 + 1e3 * (0.85 * 0.85 / 20.0 + 0.85 * kRampFollowing_s), 1e-9);
  EXPECT_NEAR(b.time_s, 0.1 + 0.085 + kSwitchOff_s, 1e-12);
}

TEST(Stopping, EveryWayOfStoppingHasABoundForEveryAxis) {
  const MachineConfig c = Good();
  const std::vector<StopWay> ways = StopWays(c);
  EXPECT_EQ(ways.size(), 9U);
  for (const StopWay& way : ways) {
    ASSERT_EQ(way.axes.size(), 2U) << way.name;
    for (const StopBound& b : way.axes) {
      EXPECT_GT(b.time_s, 0.0) << way.name;
      EXPECT_LT(b.time_s, 0.3) << way.name;
      EXPECT_GT(b.travel_mm, 0.0) << way.name;
      EXPECT_LT(b.travel_mm, 45.0) << way.name;
    }
  }
  MachineConfig without_io = c;
  without_io.io.modbus.reset();
  EXPECT_EQ(StopWays(without_io).size(), 6U);
}

TEST(Stopping, ASlowerAxisSlowsTheStopOfAll) {
  MachineConfig c = Good();
  const double before_s = StopWays(c)[0].axes[0].time_s;
  c.axes.at("y").limits.acceleration_mm_s2 = 500;
  const StopWay way = StopWays(c)[0];
  EXPECT_EQ(way.axes[0].time_s, way.axes[1].time_s);
  EXPECT_GT(way.axes[0].time_s, 2.0 * before_s);
}

}  // namespace
}  // namespace contour
