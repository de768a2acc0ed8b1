#include "design/loop_judgement.h"

#include <gtest/gtest.h>

#include "config/load_machine.h"
#include "design/loop_report.h"

namespace contour {
namespace {

MachineConfig SingleAxis(double regulator_Hz) {
  return LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml",
                     {"axes.x.loop.regulator_Hz=" + std::to_string(regulator_Hz)});
}

TEST(LoopJudgement, FindsNothingWrongWithWhatTheExampleStates) {
  const MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml");
  EXPECT_TRUE(LoopFaults(machine).empty());
  EXPECT_EQ(StatedLoopsOf(machine, "x").size(), 1u);
}

TEST(LoopJudgement, RefusesWhatIsUnstableWhateverIsDemanded) {
  const MachineConfig machine = SingleAxis(150.0);
  for (const LoopDemand demand : {LoopDemand::kStability, LoopDemand::kStabilityAsStated}) {
    const LoopVerdicts verdicts = JudgeStatedLoops(machine, demand);
    ASSERT_EQ(verdicts.refused.size(), 1u);
    EXPECT_TRUE(verdicts.refused.front().starts_with(
        "axes.x.loop: found a loop that does not keep its limits (unstable: "))
        << verdicts.refused.front();
    EXPECT_TRUE(verdicts.warned.empty());
  }
}

TEST(LoopJudgement, WarnsOfALimitThatIsNoMatterOfStability) {
  const MachineConfig machine = SingleAxis(35.0);
  ASSERT_EQ(LoopFaults(machine).size(), 1u);
  const LoopVerdicts verdicts = JudgeStatedLoops(machine, LoopDemand::kStability);
  EXPECT_TRUE(verdicts.refused.empty());
  ASSERT_EQ(verdicts.warned.size(), 1u);
  EXPECT_NE(verdicts.warned.front().find("(peak "), std::string::npos) << verdicts.warned.front();
}

TEST(LoopJudgement, OfALoopThatIsHandedInForCommissioningTheAxisAsStatedDecides) {
  MachineConfig machine = SingleAxis(60.0);
  EXPECT_EQ(JudgeStatedLoops(machine, LoopDemand::kStability).refused.size(), 1u);
  const LoopVerdicts verdicts = JudgeStatedLoops(machine, LoopDemand::kStabilityAsStated);
  EXPECT_TRUE(verdicts.refused.empty());
  ASSERT_EQ(verdicts.warned.size(), 1u);
  EXPECT_NE(verdicts.warned.front().find("stable on the axis as stated"), std::string::npos);
  machine = SingleAxis(150.0);
  EXPECT_EQ(JudgeStatedLoops(machine, LoopDemand::kStabilityAsStated).refused.size(), 1u);
}

TEST(LoopJudgement, ThePeakBeyondALimitThatRoundingMayTakeIsSaidToBeKept) {
  const MachineConfig machine = SingleAxis(27.0);
  EXPECT_TRUE(LoopFaults(machine).empty());
  const StatedLoop loop = StatedLoopsOf(machine, "x").front();
  const std::string text = Describe(ReportOn(loop.axis, loop.tuning, 1e-3));
  EXPECT_NE(text.find("peak 2.02, limit 2.00, kept: "), std::string::npos) << text;
}

TEST(LoopJudgement, RefusesATuningThatGivesNoLoop) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml");
  machine.axes.at("x").loop->regulator_Hz = 0.0;
  for (const LoopDemand demand : {LoopDemand::kStability, LoopDemand::kStabilityAsStated}) {
    const LoopVerdicts verdicts = JudgeStatedLoops(machine, demand);
    ASSERT_EQ(verdicts.refused.size(), 1u);
    EXPECT_NE(verdicts.refused.front().find("expected a positive number"), std::string::npos)
        << verdicts.refused.front();
  }
}

TEST(LoopJudgement, LeavesLoopsAloneThatNothingUses) {
  MachineConfig machine = SingleAxis(150.0);
  machine.control.friction = FrictionKind::kSrukf;
  EXPECT_TRUE(LoopFaults(machine).empty());
  machine = SingleAxis(150.0);
  machine.axes.at("x").drive.mode = DriveMode::kCsp;
  EXPECT_TRUE(LoopFaults(machine).empty());
  machine = SingleAxis(150.0);
  machine.machine.controller = ControllerName::kPid;
  EXPECT_TRUE(LoopFaults(machine).empty());
}

}  // namespace
}  // namespace contour
