#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/closed_loop/test_machine.h"

namespace contour::test {
namespace {

struct CornerResult {
  double table_peak_m = 0.0;  ///< against the programmed path, from the first cycle to the last
  double scored_peak_m = 0.0;
  double torque_peak_Nm = 0.0;
  double duration_s = 0.0;
};

CornerResult Draw(const EmulatedMachineFile& file, const std::string& shape, const std::string& corners,
                  int feed_mm_min = 3000) {
  const Program program =
      ParseProgram("{shape: " + shape + ", side_mm: 10, feed_mm_min: " + std::to_string(feed_mm_min) +
                       ", turns: 3, " + corners + "}",
                   "polygon of the test", ProgramFormat::kYaml);
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  CornerResult result;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr || !machine.plan()) return;
    PerAxis<double> table;
    for (const AxisTruth& a : truth->axes) table.push_back(a.table_position_m);
    for (const AxisRecord& a : r.axes)
      result.torque_peak_Nm = std::max(result.torque_peak_Nm, std::abs(a.torque_Nm));
    const double error_m = machine.plan()->Distance_m(table);
    result.table_peak_m = std::max(result.table_peak_m, error_m);
    if (machine.plan()->Scored(r.path_time_s)) result.scored_peak_m = std::max(result.scored_peak_m, error_m);
    result.duration_s = machine.plan()->duration_s();
  });
  machine.Run(program);
  return result;
}

constexpr double kRatedTorque_Nm = 0.637;

TEST(Corners, AToleranceIsKeptAtTheTable) {
  for (const char* shape : {"diamond", "square"}) {
    for (const char* seed : {"emulator.seed=1", "emulator.seed=2", "emulator.seed=3"}) {
      const CornerResult result = Draw(ExampleMachine({seed}), shape, "corner_tolerance_mm: 0.005");
      EXPECT_LT(result.table_peak_m, 5e-6) << shape << ", " << seed;
      EXPECT_GT(result.table_peak_m, 2.5e-6) << shape << ", " << seed << ": corners are blended";
      EXPECT_LT(result.torque_peak_Nm, kRatedTorque_Nm) << shape << ", " << seed;
    }
  }
}

TEST(Corners, AtFullFeedWithinTheRatedTorque) {
  for (const char* shape : {"diamond", "square"}) {
    for (const char* seed : {"emulator.seed=1", "emulator.seed=2"}) {
      const CornerResult result =
          Draw(ExampleMachine({seed, "axes.x.limits.torque_Nm=0.637", "axes.y.limits.torque_Nm=0.637",
                               "axes.x.drive.quick_stop_deceleration_rad_s2=9000",
                               "axes.y.drive.quick_stop_deceleration_rad_s2=9000"}),
               shape, "corners: velocity_jump");
      EXPECT_LT(result.scored_peak_m, 10e-6) << shape << ", " << seed;
      EXPECT_LE(result.torque_peak_Nm, kRatedTorque_Nm) << shape << ", " << seed;
      EXPECT_GT(result.torque_peak_Nm, 0.3) << shape << ", " << seed << ": nothing slows down";
    }
  }
}

// A corner's jerk throws the axis that starts or stops far off what the filter expects. It may take that for
// an error of the friction level, but not for an axis without friction, which then hunts.
TEST(Corners, AJerkDoesNotTakeTheFrictionForMissing) {
  for (const char* seed : {"emulator.seed=3", "emulator.seed=6", "emulator.seed=7"}) {
    const CornerResult result = Draw(ExampleMachine({seed}), "square", "corners: velocity_jump", 1000);
    EXPECT_LT(result.scored_peak_m, 20e-6) << seed;
  }
}

}  // namespace
}  // namespace contour::test
