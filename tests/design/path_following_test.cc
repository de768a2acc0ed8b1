#include "design/path_following.h"

#include <gtest/gtest.h>

#include "config/load_machine.h"
#include "config/loop_axis.h"
#include "design/loop_choice.h"

namespace contour {
namespace {

const std::string kFamily = std::string(CONTOUR_CONFIG_DIR) + "/family";

double Following_mm(const std::string& name, std::vector<std::string> set = {}) {
  const std::string file = kFamily + "/" + name + ".yaml";
  const std::vector<std::string> loops = LoopsThatAreMissing(LoadMachine(file, set));
  set.insert(set.end(), loops.begin(), loops.end());
  return ExpectedFollowing_mm(LoadMachine(file, set));
}

// Where a machine follows better or worse by more than a factor, so does what is expected of it.
TEST(PathFollowing, IsThatOfTheMachine) {
  const double base_mm = Following_mm("base"), slow_mm = Following_mm("slow40");
  EXPECT_GT(base_mm, 5e-4);
  EXPECT_LT(base_mm, 5e-3);
  EXPECT_GT(slow_mm, 5.0 * base_mm);
}

TEST(PathFollowing, GoesWithTheForceThatTheLoopIsMadeFor) {
  const double once_mm = Following_mm("base");
  EXPECT_NEAR(
      Following_mm("base", {"axes.x.loop_limits.force_step=0.2", "axes.y.loop_limits.force_step=0.2"}),
      2.0 * once_mm, 0.02 * once_mm);
}

// Of a loop that the drive closes nothing is known but the screw in front of it.
TEST(PathFollowing, InPositionModeTheScrewTells) {
  const std::vector<std::string> csp{"axes.x.drive.mode=csp", "axes.y.drive.mode=csp"};
  const MachineConfig machine = LoadMachine(kFamily + "/base.yaml", csp);
  const double step_N = 0.1 * LoopAxisOf(machine.axes.at("x")).rated_force_N;
  EXPECT_NEAR(ExpectedFollowing_m(machine, machine.axes.at("x")), step_N / 47.8e6, 1e-8);
}

TEST(PathFollowing, WhatTheFileStatesStays) {
  const MachineConfig machine = LoadMachine(kFamily + "/base.yaml", {"machine.path_following_mm=0.004"});
  EXPECT_TRUE(PathFollowingIfMissing(machine).empty());
  const std::vector<std::string> missing = PathFollowingIfMissing(LoadMachine(kFamily + "/base.yaml"));
  ASSERT_EQ(missing.size(), 1U);
  const MachineConfig with = LoadMachine(kFamily + "/base.yaml", missing);
  EXPECT_GT(with.machine.path_following_mm.value_or(0.0), 0.0);
}

}  // namespace
}  // namespace contour
