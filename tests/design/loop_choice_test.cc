#include "design/loop_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "design/loop_margins.h"
#include "tests/design/family_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

TEST(LoopChoice, GivesEveryBallScrewALoopThatKeepsItsLimits) {
  for (const char* name : {"base", "t50", "m300", "soft"}) {
    const LoopAxis axis = AxisOf(name);
    const std::optional<LoopTuning> chosen = ChooseLoop(axis, kPeriod_s);
    ASSERT_TRUE(chosen) << name;
    EXPECT_TRUE(
        Acceptable(LoopJudge(axis, kPeriod_s).Judge(DesignLoop(axis.axis, *chosen, kPeriod_s, false))))
        << name;
  }
}

TEST(LoopChoice, GoesByThePeriodOfTheCycle) {
  const LoopAxis axis = AxisOf("t20");
  const std::optional<LoopTuning> chosen = ChooseLoop(axis, 0.5 * kPeriod_s);
  ASSERT_TRUE(chosen);
  EXPECT_TRUE(Acceptable(
      LoopJudge(axis, 0.5 * kPeriod_s).Judge(DesignLoop(axis.axis, *chosen, 0.5 * kPeriod_s, false))));
}

TEST(LoopChoice, HasNoneForABelt) {
  const LoopAxis axis = AxisOf("belt");
  EXPECT_FALSE(ChooseLoop(axis, kPeriod_s));
  EXPECT_TRUE(WhyNoLoop("x", {"one", "another"}).starts_with("axes.x.loop: missing, and none of"));
  EXPECT_TRUE(WhyNoLoop("x", {"one", "another"}).ends_with("; what would help: one; another"));
}

// The search for what would help takes some twenty seconds, and what starts waits for this.
TEST(LoopChoice, LeavesWhatWouldHelpToWhoeverAsksForIt) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/family/belt.yaml");
  for (auto& [name, axis] : machine.axes) axis.loop.reset();
  machine.control.friction = FrictionKind::kLinear;
  machine.control.friction_stated = true;
  machine.machine.controller = ControllerName::kFull;
  for (auto& [name, axis] : machine.axes) axis.drive.mode = DriveMode::kCst;
  std::size_t begun = 0;
  try {
    LoopsThatAreMissing(machine, "belt.yaml", [&begun] { ++begun; });
    ADD_FAILURE() << "a loop for a belt";
  } catch (const ConfigError& e) {
    for (const std::string& message : e.messages())
      EXPECT_TRUE(message.starts_with("belt.yaml: axes.")) << message;
    EXPECT_NE(std::string(e.what()).find("in which the drive closes the loop; contour check tries other"),
              std::string::npos)
        << e.what();
  }
  EXPECT_EQ(begun, machine.axes.size());
}

// One axis without a loop is enough for the filter; the others are not searched.
TEST(LoopChoice, EndsAtTheFirstAxisWhereTheFilterIsAWayOut) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
  for (auto& [name, axis] : machine.axes) {
    axis.loop.reset();
    axis.drive.mode = DriveMode::kCst;
  }
  machine.control.friction = FrictionKind::kLinear;
  machine.control.friction_stated = false;
  machine.machine.cycle_us = 4000.0;
  std::size_t begun = 0;
  const std::vector<std::string> found = LoopsThatAreMissing(machine, "xy.yaml", [&begun] { ++begun; });
  EXPECT_EQ(found, std::vector<std::string>{kUseFilter});
  EXPECT_EQ(begun, 1u);
}

TEST(LoopChoice, CompletesAMachineFileAndNothingElse) {
  const std::string example = std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml";
  MachineConfig machine = LoadMachine(example);
  machine.axes.at("x").loop.reset();
  machine.control.friction = FrictionKind::kLinear;
  const std::vector<std::string> found = LoopsThatAreMissing(machine, example);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found.front().starts_with("axes.x.loop={regulator_Hz: ")) << found.front();
  EXPECT_EQ(LoopsThatAreMissing(machine, example), found);
  const MachineConfig completed = LoadMachine(example, found);
  EXPECT_TRUE(completed.axes.at("x").loop);
  EXPECT_TRUE(LoopsThatAreMissing(completed, example).empty());
  MachineConfig other = machine;
  other.control.friction = FrictionKind::kSrukf;
  EXPECT_TRUE(LoopsThatAreMissing(other, example).empty());
  other = machine;
  other.machine.controller = ControllerName::kPid;
  EXPECT_TRUE(LoopsThatAreMissing(other, example).empty());
  other = machine;
  other.axes.at("x").drive.mode = DriveMode::kCsp;
  EXPECT_TRUE(LoopsThatAreMissing(other, example).empty());
}

}  // namespace
}  // namespace contour
