#include "daemon/control_socket/machine_status.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace contour {
namespace {

MachineStatus Running() {
  MachineStatus s;
  s.record.state = MachineState::kRunning;
  s.record.path_time_s = 10.0;
  s.program_duration_s = 70.0;
  return s;
}

nlohmann::json LeftOf(const MachineStatus& s) { return ToJson(s)["program"]["left_s"]; }

TEST(TimeLeft, GoesWithTheFeed) {
  MachineStatus s = Running();
  EXPECT_DOUBLE_EQ(LeftOf(s), 60.0);
  s.pace.feed_percent = 50.0;
  EXPECT_DOUBLE_EQ(LeftOf(s), 120.0);
}

// Above the programmed feed it is what the axes allow, and never less than the feed alone would give.
TEST(TimeLeft, AboveTheProgrammedFeedIsWhatTheAxesAllow) {
  MachineStatus s = Running();
  s.pace.feed_percent = 200.0;
  s.program_time_share = 0.8;
  EXPECT_DOUBLE_EQ(LeftOf(s), 48.0);
  s.program_time_share = 0.1;
  EXPECT_DOUBLE_EQ(LeftOf(s), 30.0);
  s.program_time_share = 1.3;
  EXPECT_DOUBLE_EQ(LeftOf(s), 60.0);
  s.pace.feed_fixed = true;
  s.program_time_share = 0.8;
  EXPECT_DOUBLE_EQ(LeftOf(s), 60.0);
}

TEST(TimeLeft, IsNotToldOfAProgramThatStands) {
  MachineStatus s = Running();
  s.pace.pause_wanted = true;
  EXPECT_TRUE(LeftOf(s).is_null());
  s = Running();
  s.pace.feed_percent = 0.0;
  EXPECT_TRUE(LeftOf(s).is_null());
  s = Running();
  s.program_duration_s = 0.0;
  EXPECT_TRUE(LeftOf(s).is_null());
  s = Running();
  s.record.state = MachineState::kReady;
  EXPECT_TRUE(LeftOf(s).is_null());
}

}  // namespace
}  // namespace contour
