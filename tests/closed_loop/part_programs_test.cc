#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/closed_loop/test_machine.h"
#include "tests/daemon/program/part_programs.h"

namespace contour::test {
namespace {

/// Largest distance of the table from the programmed path.
double TablePeak_m(const std::string& text) {
  VirtualMachine machine(ExampleMachine({}), ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  double peak_m = 0.0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr || !machine.plan()) return;
    PerAxis<double> table;
    for (const AxisTruth& a : truth->axes) table.push_back(a.table_position_m);
    peak_m = std::max(peak_m, machine.plan()->Distance_m(table));
  });
  machine.Run(ParseProgram(text, "part.ngc", ProgramFormat::kGcode));
  return peak_m;
}

TEST(PartProgramsInTheLoop, TheTableKeepsTheTolerance) {
  EXPECT_LT(TablePeak_m(contour::testing::RapidZigzag(6)), 10e-6);
  EXPECT_LT(TablePeak_m("F3000\nG1 X7.071 Y7.071\nX0 Y14.142\nX-7.071 Y7.071\nX0 Y0\n"), 10e-6);
  EXPECT_LT(TablePeak_m(contour::testing::ChordCircle(5, 0.02, 3, 3000)), 10e-6);
  EXPECT_LT(TablePeak_m(contour::testing::EngravedText(3, 2, 0.05, 3, 1500)), 10e-6);
}

}  // namespace
}  // namespace contour::test
