#include "daemon/rest_swing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "daemon/make_cycle_config.h"
#include "tests/closed_loop/test_machine.h"

namespace contour::test {
namespace {

struct Watched {
  std::vector<std::string> warnings;
  std::vector<std::string> logged;
  double swing_m = 0.0;  ///< of axis x in the last second
  double frequency_Hz = 0.0;
};

/// After a motion, which strikes what swings.
Watched Hold(std::vector<std::string> set) {
  for (const char* axis : {"x", "y"}) set.push_back(std::string("axes.") + axis + ".drive.mode=csp");
  const EmulatedMachineFile file = ExampleMachine(set);
  RestSwing rest(MakeCycleConfig(file.machine, ControllerName::kFull));
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  Watched seen;
  std::vector<double> position_m;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    rest.Consume(entry.output.record);
    position_m.push_back(entry.output.record.axes[0].position_m);
  });
  machine.Run(
      ParseProgram("{sequence: [{shape: creep, axis: x, stroke_mm: 5, velocities_mm_s: [20]}, {shape: hold, "
                   "seconds: 12}]}",
                   "a stroke", ProgramFormat::kYaml));
  const auto last = position_m.end() - 1000;
  const auto [least, most] = std::minmax_element(last, position_m.end());
  seen.swing_m = *most - *least;
  const double middle_m = 0.5 * (*least + *most);
  for (auto at = last; at + 1 != position_m.end(); ++at)
    seen.frequency_Hz += (*at > middle_m) != (*(at + 1) > middle_m) ? 0.5 : 0.0;
  seen.warnings = rest.warnings();
  seen.logged = rest.TakeNew();
  return seen;
}

TEST(RestSwing, DrivesInOrderAreNotToldOf) {
  const Watched fine = Hold({});
  EXPECT_TRUE(fine.warnings.empty()) << fine.warnings.front();
  // Steps of 0.5 um, about which a loop that adds up what they leave goes to and fro.
  std::vector<std::string> set;
  for (const std::string axis : {"axes.x.", "axes.y."}) {
    set.push_back(axis + "drive.encoder_counts_per_rev=10000");
    set.push_back(axis + "limits.safe_travel_mm=5");
  }
  const Watched coarse = Hold(set);
  EXPECT_TRUE(coarse.warnings.empty()) << coarse.warnings.front();
}

// One that swings as slowly as its integral action, and one that does so too fast for half waves to be told
// apart. Before the first was shown as fallen_back, and the other not at all.
TEST(RestSwing, ADriveWhoseLoopSwingsAtRestIsToldWithItsSize) {
  const std::string cascade = "emulator.axes.x.cascade.";
  for (const std::vector<std::string>& gains :
       {std::vector<std::string>{cascade + "velocity_integral_1_s=2000"},
        {cascade + "velocity_gain_1_s=3000", cascade + "position_gain_1_s=3000"}}) {
    const Watched seen = Hold(gains);
    ASSERT_EQ(seen.warnings.size(), 1u) << gains.front();
    EXPECT_EQ(seen.logged.size(), 1u);
    const std::string& text = seen.warnings.front();
    EXPECT_TRUE(text.starts_with("axis x swings while its set-point rests, by ")) << text;
    // Counts of 5 mm / 2^20, and what they are in micrometres.
    const double counts = std::stod(text.substr(text.find("by ") + 3));
    EXPECT_NEAR(counts * 5e-3 / 1048576.0, seen.swing_m, 0.3 * seen.swing_m) << text;
    const double told_m = 1e-6 * std::stod(text.substr(text.find('(') + 1));
    EXPECT_NEAR(told_m, counts * 5e-3 / 1048576.0, 0.01 * told_m) << text;
    const double told_Hz = std::stod(text.substr(text.find("some ") + 5));
    EXPECT_NEAR(told_Hz, seen.frequency_Hz, 0.2 * seen.frequency_Hz) << text;
  }
}

}  // namespace
}  // namespace contour::test
