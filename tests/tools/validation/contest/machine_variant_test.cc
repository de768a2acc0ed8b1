#include "tools/validation/contest/machine_variant.h"

#include <gtest/gtest.h>

#include "config/config_error.h"

namespace contour {
namespace {

YamlValue File() {
  return ParseYamlText(
      "axes: {x: {drive: {n: 1}}, y: {drive: {n: 2}}}\nemulator: {axes: {x: {m: 4}, y: {m: 6}}}\n", "file");
}

using List = std::vector<std::string>;

TEST(Assignments, AStarStandsForEveryAxis) {
  EXPECT_EQ(ExpandAssignments(File(), {"axes.*.drive.n=7", "emulator.axes.*.e={a: 1, b: 2}"}),
            (List{"axes.x.drive.n=7", "axes.y.drive.n=7", "emulator.axes.x.e={a: 1, b: 2}",
                  "emulator.axes.y.e={a: 1, b: 2}"}));
}

TEST(Assignments, AFactorMultipliesWhatTheFileSays) {
  EXPECT_EQ(ExpandAssignments(File(), {"emulator.axes.*.m*=1.5"}),
            (List{"emulator.axes.x.m=6", "emulator.axes.y.m=9"}));
}

TEST(Assignments, OthersAreLeftAsTheyAre) {
  EXPECT_EQ(ExpandAssignments(File(), {"machine.cycle_us=2000"}), List{"machine.cycle_us=2000"});
}

TEST(Assignments, AFactorNeedsANumberOnBothSides) {
  EXPECT_THROW(ExpandAssignments(File(), {"emulator.axes.*.k*=2"}), ConfigError);
  EXPECT_THROW(ExpandAssignments(File(), {"emulator.axes.*.m*=two"}), ConfigError);
  EXPECT_THROW(ExpandAssignments(File(), {"emulator.axes.x*=2"}), ConfigError);
}

}  // namespace
}  // namespace contour
