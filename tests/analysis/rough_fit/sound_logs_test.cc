#include "analysis/rough_fit/sound_logs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made() {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  return test::MakeHiddenAxis(o);
}

// Before: ten such readings made `contour identify` refuse a ball screw for an antiresonance that was not
// there.
TEST(MakeSound, WrongReadingsOfAllLogsAreLeftOutAndCounted) {
  const test::HiddenAxis axis = Made();
  std::vector<AxisLog> logs = {axis.log, axis.log};
  for (const std::size_t k : {4000U, 9000U, 15001U}) logs[0].position[k] += 5.0;
  logs[1].position[7000] -= 5.0;
  const SoundLogs sound = MakeSound(logs, axis.stated);
  EXPECT_EQ(sound.unusable, "");
  EXPECT_EQ(sound.note, "Single wrong readings of the position were left out: 4.");
  EXPECT_EQ(logs[0].present[9000], 0);
  EXPECT_TRUE(std::isnan(logs[1].position[7000]));
  EXPECT_EQ(logs[1].present[9000], 1);
}

TEST(MakeSound, NothingIsSaidOfSoundOnes) {
  test::HiddenAxis axis = Made();
  const std::vector<double> before = axis.log.position;
  const SoundLogs sound = MakeSound({&axis.log, 1}, axis.stated);
  EXPECT_EQ(sound.unusable, "");
  EXPECT_EQ(sound.note, "");
  EXPECT_EQ(axis.log.position, before);
}

TEST(MakeSound, OneLogOfAnotherSignIsEnough) {
  const test::HiddenAxis axis = Made();
  std::vector<AxisLog> logs = {axis.log, axis.log};
  for (double& u : logs[1].command) u = -u;
  EXPECT_NE(MakeSound(logs, axis.stated).unusable.find("opposite signs"), std::string::npos);
}

}  // namespace
}  // namespace contour::diagnosis
