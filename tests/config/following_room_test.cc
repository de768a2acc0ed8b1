#include "config/following_room.h"

#include <gtest/gtest.h>

#include "config/load_machine.h"
#include "tests/config/test_files.h"

namespace contour {
namespace {

MachineConfig InCsp() {
  MachineConfig c = LoadMachine(ExampleMachine("xy_emulated.yaml"));
  for (auto& [name, axis] : c.axes) axis.drive.mode = DriveMode::kCsp;
  return c;
}

TEST(FollowingRoom, IsWindUpAndOneCycleOfTheHighestSpeed) {
  MachineConfig c = InCsp();
  AxisConfig& axis = c.axes.at("x");
  axis.model.mechanics.screw_stiffness_N_um = 40.0;
  axis.model.mechanics.table_mass_kg = 10.0;
  axis.model.friction.Fs_plus_N = axis.model.friction.Fs_minus_N = 50.0;
  axis.limits.external_force_N = 200.0;
  axis.limits.acceleration_mm_s2 = 5000.0;
  axis.limits.velocity_mm_s = 250.0;
  axis.limits.following_error_mm = 0.5;
  const FollowingRoom room = FollowingRoomOf(c, axis);
  EXPECT_NEAR(room.wound_mm, 300.0 / 40.0e3, 1e-12);
  EXPECT_NEAR(room.late_mm, 0.25, 1e-12);
  EXPECT_NEAR(room.feed_mm_s, (0.5 - 0.0075) / 1e-3, 1e-9);
  EXPECT_NEAR(room.expected_mm, 0.2575, 1e-12);
}

TEST(FollowingRoom, TheExampleHasEnough) { EXPECT_TRUE(FollowingAdvice(InCsp()).empty()); }

TEST(FollowingRoom, LongCyclesAndSoftScrewsHaveNot) {
  MachineConfig slow = InCsp();
  slow.machine.cycle_us = 4000;
  ASSERT_EQ(FollowingAdvice(slow).size(), 2u);
  EXPECT_TRUE(FollowingAdvice(slow).front().starts_with("axes.x.limits.following_error_mm: found 0.5, but"))
      << FollowingAdvice(slow).front();
  MachineConfig soft = InCsp();
  soft.axes.at("y").model.mechanics.screw_stiffness_N_um = 0.4;
  ASSERT_EQ(FollowingAdvice(soft).size(), 1u);
  EXPECT_NE(FollowingAdvice(soft).front().find("may be stopped above 0 mm/s"), std::string::npos)
      << FollowingAdvice(soft).front();
  // What it names is enough.
  const std::vector<std::string> advice = FollowingAdvice(slow);
  for (std::size_t i = 0; auto& [name, axis] : slow.axes) {
    const std::string& text = advice[i++];
    const std::size_t end = text.rfind(" mm leave room");
    axis.limits.following_error_mm = std::stod(text.substr(text.rfind(' ', end - 1) + 1));
  }
  EXPECT_TRUE(FollowingAdvice(slow).empty());
}

TEST(FollowingRoom, InTorqueModeTheFeedforwardLeadsTheDrive) {
  MachineConfig c = InCsp();
  c.machine.cycle_us = 4000;
  for (auto& [name, axis] : c.axes) axis.drive.mode = DriveMode::kCst;
  EXPECT_TRUE(FollowingAdvice(c).empty());
}

}  // namespace
}  // namespace contour
