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

TEST(LoopChoice, HasNoneForABeltAndSaysWhatWouldHelp) {
  const LoopAxis axis = AxisOf("belt");
  EXPECT_FALSE(ChooseLoop(axis, kPeriod_s));
  const std::string why = WhyNoLoop("x", axis, kPeriod_s);
  EXPECT_NE(why.find("axes.x.loop: missing"), std::string::npos) << why;
  for (const char* help : {"what would help: drive.mode: csp", "; a linear scale at the table, in the loop"})
    EXPECT_NE(why.find(help), std::string::npos) << why;
}

TEST(LoopChoice, CompletesAMachineFileAndNothingElse) {
  const std::string example = std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml";
  MachineConfig machine = LoadMachine(example);
  machine.axes.at("x").loop.reset();
  machine.control.friction = FrictionKind::kLinear;
  const std::vector<std::string> found = LoopsThatAreMissing(machine);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found.front().starts_with("axes.x.loop={regulator_Hz: ")) << found.front();
  EXPECT_EQ(LoopsThatAreMissing(machine), found);
  const MachineConfig completed = LoadMachine(example, found);
  EXPECT_TRUE(completed.axes.at("x").loop);
  EXPECT_TRUE(LoopsThatAreMissing(completed).empty());
  MachineConfig other = machine;
  other.control.friction = FrictionKind::kSrukf;
  EXPECT_TRUE(LoopsThatAreMissing(other).empty());
  other = machine;
  other.machine.controller = ControllerName::kPid;
  EXPECT_TRUE(LoopsThatAreMissing(other).empty());
  other = machine;
  other.axes.at("x").drive.mode = DriveMode::kCsp;
  EXPECT_TRUE(LoopsThatAreMissing(other).empty());
}

}  // namespace
}  // namespace contour
