#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

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

/// One axis runs on at feed, the other one starts slowly, again in the direction in which it stopped: what is
/// hardest for friction compensation in programs of lines.
SpaceRun SlowStart(const std::string& fast, const std::string& slow) {
  std::string gcode = "G21 G90 G64 P0.005 F1200\n";
  const auto to = [&](int fast_mm, const char* slow_mm) {
    gcode += "G1 " + fast + std::to_string(fast_mm) + " " + slow + slow_mm + "\n";
  };
  to(10, "0");
  to(20, "-0.6");
  for (int i = 0; i < 4; ++i) {
    to(30, "-0.6");
    to(10, "-0.6");
  }
  to(30, "-0.6");
  to(40, "-1.2");
  to(60, "-1.2");
  return RunInSpace(gcode, 0.0);
}

TEST(Space, ASlowStartOfTheThirdAxisIsAsInThePlane) {
  const SpaceRun y = SlowStart("X", "Y"), x = SlowStart("Y", "X");
  const SpaceRun z = SlowStart("X", "Z");
  EXPECT_LT(z.peak_m, 1.5 * std::max(x.peak_m, y.peak_m));
  EXPECT_LT(z.rms_m, 1.5 * std::max(x.rms_m, y.rms_m));
  for (const SpaceRun& run : {x, y, z}) EXPECT_LT(run.peak_m, 5e-6);
}

/// A pocket without its ramps is drawn within its own tolerance, friction and all.
TEST(Space, APocketKeepsItsToleranceAtTheTable) {
  const char* const text =
      "G21 G64 P0.005 F1200\nG1 X17 Y10\nG2 X17 Y10 I-2 P2\n#1=1\no1 while [#1 le 3]\n#2=[#1*3]\n"
      "G1 X[15+#2] Y10\nG1 Y[10+#1]\nG3 X[13+#2] Y[12+#1] I-2 J0\nG1 X[17-#2]\nG3 X[15-#2] Y[10+#1] I0 J-2\n"
      "G1 Y[10-#1]\nG3 X[17-#2] Y[8-#1] I2 J0\nG1 X[13+#2]\nG3 X[15+#2] Y[10-#1] I0 J2\nG1 Y10\n#1=[#1+1]\n"
      "o1 endwhile\nM2\n";
  EXPECT_LT(RunInSpace(text, 0.0).peak_m, 5e-6);
}

/// With its ramps: an axis that rested for seconds starts slowly down, in the direction in which it stopped.
TEST(Space, APocketWithItsRampsKeepsItsToleranceAtTheTable) {
  const std::ifstream file(std::string(CONTOUR_CONFIG_DIR) + "/programs_xyz/pocket.ngc");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_LT(RunInSpace(text.str(), 0.0).peak_m, 5e-6);
}

}  // namespace
}  // namespace contour::test
