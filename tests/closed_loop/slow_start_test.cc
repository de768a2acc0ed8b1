#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tools/simulate/virtual_machine.h"

// An axis that rested starts slowly. While it rested its friction gave way, on the machine and in what is
// foreseen.
namespace contour::test {
namespace {

/// X runs at feed for four seconds, Y rests and starts down its ramp at 1.2 mm/s: in the direction in which
/// it stopped, or back.
std::string Ramp(bool onward) {
  std::string gcode = "G21 G90 G64 P0.005 F1200\nG1 X10 Y0\nG1 X20 Y-0.6\n";
  for (int i = 0; i < 2; ++i) gcode += "G1 X30 Y-0.6\nG1 X10 Y-0.6\n";
  const std::string end = onward ? "-1.2" : "0";
  return gcode + "G1 X30 Y-0.6\nG1 X40 Y" + end + "\nG1 X60 Y" + end + "\n";
}

/// How far Y is off its reference within 0.15 s of the start, at most; at the table.
double PeakAtStart_m(const std::string& machine, const std::vector<std::string>& set, bool onward) {
  const EmulatedMachineFile file = LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/" + machine, set);
  VirtualMachine run(file, ControllerName::kFull);
  run.BringUp();
  run.Enable();
  double peak_m = 0.0;
  int rested = 0, since = -1;
  run.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr || r.path_time_s < 0.1) return;
    const ReferencePoint& reference = r.axes[1].reference;
    if (std::abs(reference.velocity_m_s) < 1e-6) {
      ++rested;
    } else {
      if (rested > 1500) since = 0;
      rested = 0;
    }
    if (since < 0 || since > 150) return;
    ++since;
    peak_m = std::max(peak_m, std::abs(truth->axes[1].table_position_m - reference.position_m));
  });
  run.Run(ParseProgram(Ramp(onward), "ramp.ngc", ProgramFormat::kGcode));
  EXPECT_GE(since, 0);
  return peak_m;
}

const std::vector<std::string> kLinear{"control.friction=linear"};

// Before, 4.6 to 19 um.
TEST(SlowStart, AfterARestIsForeseenFromWhatTheBristlesStillCarry) {
  for (const std::string machine : {"base", "t30", "lead20", "m300"}) {
    for (const bool onward : {true, false})
      EXPECT_LT(PeakAtStart_m("family/" + machine + ".yaml", kLinear, onward), 4e-6) << machine << onward;
  }
}

// A force that came meanwhile looks like it: it must not be worse than what was foreseen without. Before, 7
// to 13 um.
TEST(SlowStart, AForceThatComesWhileTheAxisRestsIsNoWorse) {
  for (const std::string force_N : {"-60", "-20", "20", "60"}) {
    std::vector<std::string> set = kLinear;
    set.push_back("emulator.axes.y.effects.cutting_force={force_N: " + force_N + ", start_s: 3, lag_ms: 4}");
    for (const bool onward : {true, false})
      EXPECT_LT(PeakAtStart_m("family/base.yaml", set, onward), 9.2e-6) << force_N << onward;
  }
}

}  // namespace
}  // namespace contour::test
