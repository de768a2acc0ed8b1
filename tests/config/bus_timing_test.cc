#include "config/bus_timing.h"

#include <gtest/gtest.h>

#include <string>

#include "config/load_machine.h"
#include "config/machine_checks.h"
#include "tests/config/test_files.h"

namespace contour {
namespace {

// A machine of n axes like those of the example, heartbeats at 100 ms.
MachineConfig WithAxes(int n, int cycle_us) {
  MachineConfig c = LoadMachine(ExampleMachine("single_axis.yaml"));
  const AxisConfig x = c.axes.at("x");
  c.axes.clear();
  for (int i = 1; i <= n; ++i) {
    AxisConfig& axis = c.axes[std::string("a") + std::to_string(i)];
    axis = x;
    axis.drive.node_id = i;
    axis.drive.heartbeat_ms = 100;
  }
  c.machine.cycle_us = cycle_us;
  c.realtime.send_deadline_us.reset();
  return c;
}

double Response(const BusTiming& t, const std::string& name, bool emergencies) {
  for (const BusMessage& m : t.messages)
    if (m.name == name) return (emergencies ? m.response_with_emergencies_us : m.response_us).value_or(-1.0);
  ADD_FAILURE() << name;
  return 0.0;
}

// Values worked out independently from the published analysis: classic CAN at 1 Mbit/s, 8-byte feedback,
// 4-byte set-point, SDO every 2 ms.
TEST(BusTiming, KnownLayouts) {
  struct Known {
    int axes;
    int cycle_us;
    double load;
    double feedback_us;
    double set_point_us;
    double feedback_with_emergencies_us;
    double set_point_with_emergencies_us;
  };
  for (const Known& k :
       {Known{1, 1000, 0.285, 325, 420, 460, 555}, Known{2, 1000, 0.515, 460, 650, 730, 920},
        Known{3, 1000, 0.745, 595, 880, -1, -1}, Known{4, 2000, 0.4875, -1, -1, 1270, 1650}}) {
    const BusTiming t = BusTimings(WithAxes(k.axes, k.cycle_us))[0];
    const std::string last = "a" + std::to_string(k.axes);
    EXPECT_NEAR(t.cyclic_load, k.load, 1e-12);
    if (k.feedback_us > 0) {
      EXPECT_EQ(Response(t, last + " feedback (TPDO1)", false), k.feedback_us) << k.axes;
      EXPECT_EQ(Response(t, last + " set-point (RPDO1)", false), k.set_point_us) << k.axes;
      EXPECT_EQ(*t.worst_us, k.set_point_us);
    }
    if (k.feedback_with_emergencies_us > 0) {
      EXPECT_EQ(Response(t, last + " feedback (TPDO1)", true), k.feedback_with_emergencies_us) << k.axes;
      EXPECT_EQ(Response(t, last + " set-point (RPDO1)", true), k.set_point_with_emergencies_us) << k.axes;
    }
  }
}

std::string Only(const MachineConfig& c) {
  const std::vector<ConfigProblem> problems = Check(c);
  EXPECT_EQ(problems.size(), 1U);
  return problems.empty() ? "" : problems[0].key + ": " + problems[0].message;
}

TEST(BusTiming, LayoutsThatFitAndThoseThatDoNot) {
  EXPECT_TRUE(Check(WithAxes(1, 1000)).empty());
  EXPECT_TRUE(Check(WithAxes(2, 1000)).empty());
  MachineConfig two_ms = WithAxes(4, 2000);
  // What is lost in two periods takes the axis further.
  for (auto& [name, axis] : two_ms.axes) axis.limits.safe_travel_mm = 5;
  EXPECT_TRUE(Check(two_ms).empty());
  EXPECT_EQ(Only(WithAxes(4, 1000)).substr(0, 40), "buses.main: bus overload at this cycle: ");
  EXPECT_EQ(Only(WithAxes(5, 1000)),
            "buses.main: bus overload at this cycle: the frames of a cycle take 120.5 % of 1000 us at "
            "1000000 bit/s");
  MachineConfig slow = WithAxes(2, 1000);
  slow.buses.at("main").bitrate_bit_s = 500000;
  EXPECT_EQ(
      Only(slow),
      "buses.main: bus overload at this cycle: the frames of a cycle take 103 % of 1000 us at 500000 bit/s");
}

TEST(BusTiming, SendDeadlineMustLeaveRoomForTheFrames) {
  MachineConfig c = WithAxes(3, 1000);
  EXPECT_EQ(Only(c),
            "realtime.send_deadline_us: found 200 us, expected at most 120 us: frames of bus 'main' take up "
            "to 880 us, and "
            "feedback must be in at the next grid point");
  c.realtime.send_deadline_us = 120;
  EXPECT_TRUE(Check(c).empty());
}

TEST(BusTiming, LongerSetPointsAndScalesCount) {
  MachineConfig c = WithAxes(2, 1000);
  c.machine.controller = ControllerName::kCsp;
  EXPECT_NEAR(BusTimings(c)[0].cyclic_load, 0.595, 1e-12);
  c.axes.at("a1").drive.csp_torque_offset = false;
  EXPECT_NEAR(BusTimings(c)[0].cyclic_load, 0.575, 1e-12);
  c = WithAxes(2, 1000);
  for (auto& [name, axis] : c.axes) axis.drive.linear_scale = LinearScaleConfig{1000.0};
  EXPECT_NEAR(BusTimings(c)[0].cyclic_load, 0.515 + 2 * 0.095, 1e-12);
}

TEST(BusTiming, ABusWithoutDrivesIsNamed) {
  MachineConfig c = WithAxes(1, 1000);
  c.buses["spare"].interface = "can1";
  EXPECT_EQ(Only(c), "buses.spare: found a bus with no drive on it");
}

}  // namespace
}  // namespace contour
