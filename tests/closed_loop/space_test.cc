#include <gtest/gtest.h>

#include <cmath>

#include "tools/simulate/virtual_machine.h"

// Three axes, the third of another mass: contour errors in space are those in the plane.
namespace contour::test {
namespace {

struct SpaceRun {
  double rms_m = 0.0;
  double peak_m = 0.0;
};

/// Errors of the table against the whole path, once friction has been learnt in the first turn.
SpaceRun RunInSpace(const std::string& gcode, double from_s) {
  const EmulatedMachineFile file =
      LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/xyz_emulated.yaml");
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  SpaceRun run;
  double squared = 0.0;
  std::size_t rows = 0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr || !machine.plan() || r.path_time_s < from_s)
      return;
    PerAxis<double> table(3);
    for (std::size_t i = 0; i < 3; ++i) table[i] = truth->axes[i].table_position_m;
    const double error = machine.plan()->Distance_m(table);
    run.peak_m = std::max(run.peak_m, error);
    squared += error * error;
    ++rows;
  });
  machine.Run(ParseProgram(gcode, "space.ngc", ProgramFormat::kGcode));
  EXPECT_GT(rows, 1000u);
  run.rms_m = std::sqrt(squared / static_cast<double>(rows));
  return run;
}

const SpaceRun& CircleInThePlane() {
  static const SpaceRun run = RunInSpace("G17 G2 X0 Y0 I5 P4 F600\n", 4.0);
  return run;
}

void ExpectAsInThePlane(const SpaceRun& run) {
  EXPECT_GT(run.rms_m, 0.0);
  EXPECT_LT(run.rms_m, 1.5 * CircleInThePlane().rms_m);
  EXPECT_LT(run.peak_m, 1.5 * CircleInThePlane().peak_m);
}

TEST(Space, ACircleOfTheThirdAxisIsAsInThePlane) {
  ExpectAsInThePlane(RunInSpace("G18 G2 X0 Z0 I5 P4 F600\n", 4.0));
  ExpectAsInThePlane(RunInSpace("G19 G2 Y0 Z0 J5 P4 F600\n", 4.0));
}

TEST(Space, AHelixIsAsACircle) { ExpectAsInThePlane(RunInSpace("G17 G2 X0 Y0 Z-4 I5 P4 F600\n", 4.0)); }

}  // namespace
}  // namespace contour::test
