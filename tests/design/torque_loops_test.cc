#include "design/torque_loops.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "config/load_machine.h"
#include "config/loop_axis.h"
#include "design/catalogue_doubt.h"
#include "design/start_loop.h"

namespace contour {
namespace {

constexpr int kThreads = 2;

/// One axis, led by its drive.
MachineConfig OneAxisOf(const std::string& machine) {
  MachineConfig out = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/family/" + machine + ".yaml");
  out.axes.erase("y");
  out.axes.at("x").drive.mode = DriveMode::kCsp;
  out.control.friction = FrictionKind::kSrukf;
  return out;
}

TEST(TorqueLoops, AreStableForAllThatTheModelLeavesOpen) {
  MachineConfig machine = OneAxisOf("m300");
  AxisConfig& axis = machine.axes.at("x");
  axis.model.uncertainty.clear();
  const TorqueLoops found = FindTorqueLoops(machine, kThreads);
  ASSERT_TRUE(found.complete()) << found.why_not;
  EXPECT_TRUE(found.lacking.empty());
  EXPECT_EQ(WhyNotToStartWith(LoopAxisOf(axis), found.loops.at("x"), 1e-3, DoubtOf(axis.model)), "");
  const MachineConfig in_torque_mode = InTorqueMode(machine, found.loops);
  EXPECT_EQ(in_torque_mode.axes.at("x").drive.mode, DriveMode::kCst);
  EXPECT_EQ(in_torque_mode.axes.at("x").loop->regulator_Hz, found.loops.at("x").regulator_Hz);
  EXPECT_EQ(in_torque_mode.control.friction, FrictionKind::kLinear);
  EXPECT_EQ(WhyLoopsMayNotStart(in_torque_mode), "");
}

TEST(TorqueLoops, AnAxisThatNoLoopHoldsStaysWithItsDrive) {
  MachineConfig machine = OneAxisOf("belt");
  machine.axes.at("x").model.uncertainty.clear();
  const TorqueLoops found = FindTorqueLoops(machine, kThreads);
  EXPECT_FALSE(found.complete());
  EXPECT_EQ(found.lacking, (std::vector<std::string>{"x"}));
  EXPECT_NE(found.why_not.find("no loop of axis x is stable"), std::string::npos) << found.why_not;
  const MachineConfig as_it_is = InTorqueMode(machine, found.loops);
  EXPECT_EQ(as_it_is.axes.at("x").drive.mode, DriveMode::kCsp);
  EXPECT_EQ(as_it_is.control.friction, FrictionKind::kSrukf);
}

TEST(TorqueLoops, WithoutThemAllDrivesHoldTheirAxes) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/family/t30.yaml");
  machine.control.friction = FrictionKind::kSrukf;
  const MachineConfig in_csp = InCsp(machine);
  for (const auto& [name, axis] : in_csp.axes) EXPECT_EQ(axis.drive.mode, DriveMode::kCsp) << name;
  EXPECT_EQ(in_csp.control.friction, FrictionKind::kLinear);
}

// All axes change their modes together: while one was looked at, the others were left with their drives, and
// no machine of two axes was recorded in torque mode.
TEST(TorqueLoops, AreThereForEveryAxisOfAMachine) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/family/base.yaml");
  std::map<std::string, LoopTuning> known;
  for (auto& [name, axis] : machine.axes) {
    axis.drive.mode = DriveMode::kCsp;
    known[name] = *axis.loop;
  }
  machine.control.friction = FrictionKind::kSrukf;
  const TorqueLoops found = FindTorqueLoops(machine, kThreads, known);
  EXPECT_TRUE(found.complete()) << found.why_not;
  EXPECT_EQ(found.loops.size(), 2u);
}

// contourd refuses such a machine file in torque mode: after the search, and after the operator's yes.
TEST(TorqueLoops, LimitsThatDoNotDoInTorqueModeAreSaidInPlaceOfALoop) {
  MachineConfig machine = OneAxisOf("m300");
  AxisConfig& axis = machine.axes.at("x");
  axis.limits.following_error_mm = axis.limits.safe_travel_mm = 0.02;
  machine.axes["y"] = axis;
  const TorqueLoops found = FindTorqueLoops(machine, kThreads, {{"x", *axis.loop}});
  EXPECT_FALSE(found.complete());
  EXPECT_TRUE(found.lacking.empty()) << "a record in csp would not help";
  EXPECT_TRUE(found.why_not.starts_with("axes.x.limits.safe_travel_mm does not do there: found 0.02"))
      << found.why_not;
}

TEST(TorqueLoops, WhatIsKnownIsNotSearchedAgain) {
  const MachineConfig machine = OneAxisOf("t30");
  LoopTuning known = *machine.axes.at("x").loop;
  known.regulator_Hz *= 0.9;
  const TorqueLoops found = FindTorqueLoops(machine, kThreads, {{"x", known}});
  EXPECT_TRUE(found.complete()) << found.why_not;
  EXPECT_EQ(found.loops.at("x").regulator_Hz, known.regulator_Hz);
}

TEST(TorqueLoops, NoneForOtherControllersNorBesideALoopWithTheScale) {
  MachineConfig machine = OneAxisOf("t30");
  machine.machine.controller = ControllerName::kCsp;
  EXPECT_NE(FindTorqueLoops(machine, kThreads).why_not.find("controller csp"), std::string::npos);
  machine.machine.controller = ControllerName::kFull;
  machine.axes.at("x").scale_loop = LoopTuning{};
  EXPECT_NE(FindTorqueLoops(machine, kThreads).why_not.find("scale"), std::string::npos);
}

}  // namespace
}  // namespace contour
