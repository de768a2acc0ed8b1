#include "design/path_following.h"

#include <gtest/gtest.h>

#include "config/load_machine.h"
#include "config/loop_axis.h"
#include "daemon/program_limits.h"
#include "design/loop_choice.h"

namespace contour {
namespace {

const std::string kFamily = std::string(CONTOUR_CONFIG_DIR) + "/family";

double Following_mm(const std::string& name, std::vector<std::string> set = {}) {
  const std::string file = kFamily + "/" + name + ".yaml";
  const std::vector<std::string> loops = LoopsThatAreMissing(LoadMachine(file, set), file);
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

PerAxis<PlanLimits> LimitsOf(const std::string& name, std::vector<std::string> set = {}) {
  const std::string file = kFamily + "/" + name + ".yaml";
  for (const std::string& loop : LoopsThatAreMissing(LoadMachine(file, set), file)) set.push_back(loop);
  for (const std::string& following : PathFollowingIfMissing(LoadMachine(file, set)))
    set.push_back(following);
  return ProgramLimits(LoadMachine(file, set));
}

// What a program that says nothing may be off by is no less than what the machine follows, path included.
TEST(PathTolerance, WithoutOneItIsWhatTheMachineCanFollow) {
  EXPECT_EQ(LimitsOf("base")[0].path_tolerance_m, 1e-5);
  const PlanLimits slow = LimitsOf("slow40")[0];
  EXPECT_GT(slow.path_tolerance_m, 3e-5);
  EXPECT_EQ(slow.path_tolerance_m, 2.0 * slow.path_following_m);
  EXPECT_EQ(LimitsOf("slow40", {"machine.path_tolerance_mm=0.01"})[0].path_tolerance_m, 1e-5);
}

TEST(PathTolerance, AWiderOneIsSaid) {
  const auto text = [](const std::string& name, const std::vector<std::string>& set) {
    return WiderToleranceText(LoadMachine(kFamily + "/" + name + ".yaml", set));
  };
  EXPECT_FALSE(text("base", {"machine.path_following_mm=0.004"}));
  const std::optional<std::string> wider = text("base", {"machine.path_following_mm=0.02"});
  ASSERT_TRUE(wider);
  EXPECT_NE(wider->find("within 0.04 mm, not 0.01"), std::string::npos) << *wider;
  EXPECT_FALSE(text("base", {"machine.path_following_mm=0.02", "machine.path_tolerance_mm=0.03"}));
}

TEST(ScrewDoubt, IsThatOfMassStiffnessAndFriction) {
  const PlanLimits slow = LimitsOf("slow40")[0], base = LimitsOf("base")[0];
  // 498 kg on 17.9 N/um, known to 5.8 and 12 %: 17.6 um at 4.74 m/s^2; 319 N known to 29 %: 5.2 um.
  EXPECT_NEAR(slow.inertia_doubt_s2 * slow.acceleration_m_s2, 17.6e-6, 0.1e-6);
  EXPECT_NEAR(slow.friction_doubt_m, 5.2e-6, 0.1e-6);
  EXPECT_LT(base.inertia_doubt_s2 * base.acceleration_m_s2, 0.2e-6);
  EXPECT_EQ(LimitsOf("slow40", {"machine.slow_for_tolerance=false"})[0].inertia_doubt_s2, 0.0);
}

}  // namespace
}  // namespace contour
