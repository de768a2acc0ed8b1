#include <gtest/gtest.h>

#include <algorithm>

#include "tests/closed_loop/test_machine.h"

namespace contour {
namespace {

// Learning with the whole cycle and the emulated machine. What counts is the table's true position.

std::vector<std::string> OnBoth(const std::string& key) { return {"axes.x." + key, "axes.y." + key}; }

/// The example with a scale on each axis; two scales do not fit on one bus at 1 ms.
EmulatedMachineFile WithScales(bool learning, const std::string& mode, const std::string& counts_per_mm,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{"buses.second={interface: loopback, bitrate_bit_s: 1000000}",
                               "axes.y.drive.bus=second",
                               std::string("learning.enabled=") + (learning ? "true" : "false")};
  for (const std::string& key :
       {"drive.mode=" + mode, "drive.linear_scale={counts_per_mm: " + counts_per_mm + "}"})
    for (const std::string& s : OnBoth(key)) set.push_back(s);
  set.insert(set.end(), more.begin(), more.end());
  return test::ExampleMachine(set);
}

/// Largest contour error at the table of each pass, in um. With `every_s` passes begin at whole multiples of
/// it.
std::vector<double> Passes(const EmulatedMachineFile& file, const Program& program, int count,
                           double every_s = 0.0) {
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  std::vector<double> peaks_um;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr || !machine.plan()->Scored(r.path_time_s))
      return;
    PerAxis<double> table_m;
    for (const AxisTruth& a : truth->axes) table_m.push_back(a.table_position_m);
    peaks_um.back() = std::max(peaks_um.back(), 1e6 * machine.plan()->Distance_m(table_m));
  });
  const auto every = static_cast<std::uint64_t>(std::llround(1e3 * every_s));
  for (int pass = 0; pass < count; ++pass) {
    while (every != 0 && machine.record().cycle % every != 0) machine.Tick();
    peaks_um.push_back(0.0);
    machine.Run(program);
  }
  return peaks_um;
}

/// Of the last three, so that one lucky pass does not count.
double Last(const std::vector<double>& peaks_um) {
  return *std::max_element(peaks_um.end() - 3, peaks_um.end());
}

TEST(LearningOnTheMachine, AHiddenForceThatComesAgainIsLearnt) {
  std::vector<std::string> force;
  for (const char* axis : {"x", "y"})
    force.push_back(std::string("emulator.axes.") + axis +
                    ".effects.cutting_force={force_N: 60, start_s: 2, end_s: 2.5, every_s: 6}");
  const Program circle = test::Circle(10.0, 3, 0.7957747155);  // 3 m/min
  const struct {
    const char* mode;
    double share;
  } modes[] = {{"csp", 0.75}, {"cst", 0.5}};
  for (const auto& m : modes) {
    const double without = Last(Passes(WithScales(false, m.mode, "10000", force), circle, 6, 6.0));
    const double with = Last(Passes(WithScales(true, m.mode, "10000", force), circle, 6, 6.0));
    EXPECT_GT(without, 2.0) << m.mode << ": the force must be felt";
    EXPECT_LT(with, m.share * without) << m.mode;
  }
}

TEST(LearningOnTheMachine, RippleAndCoggingOnASmallCircleAreLearnt) {
  std::vector<std::string> rough;
  for (const char* axis : {"x", "y"}) {
    rough.push_back(std::string("emulator.axes.") + axis +
                    ".effects.cogging={amplitude_Nm: 0.01, order_per_rev: 12}");
    rough.push_back(std::string("emulator.axes.") + axis +
                    ".effects.torque_ripple={amplitude_rel: 0.02, order_per_rev: 6}");
  }
  const Program circle = test::Circle(0.1, 3, 0.7853981634);
  // One machine alone gains anything from two thirds to nothing.
  double without = 0.0, with = 0.0;
  for (int seed = 1; seed <= 3; ++seed) {
    std::vector<std::string> machine = rough;
    machine.push_back("emulator.seed=" + std::to_string(seed));
    without += Last(Passes(WithScales(false, "csp", "10000", machine), circle, 5));
    with += Last(Passes(WithScales(true, "csp", "10000", machine), circle, 5));
  }
  EXPECT_LT(with, 0.75 * without);
}

// Beyond the bandwidth that the drives follow, each pass would be worse than the one before: 30 um after
// five.
TEST(LearningOnTheMachine, ABandwidthThatTheDrivesDoNotFollowDoesNotSwingItUp) {
  const Program circle = test::Circle(10.0, 3, 2.6525823849);  // 10 m/min
  const std::vector<double> without = Passes(WithScales(false, "csp", "10000"), circle, 3);
  const std::vector<double> with =
      Passes(WithScales(true, "csp", "10000", {"learning.bandwidth_Hz=100"}), circle, 20);
  EXPECT_LT(*std::max_element(with.begin(), with.end()),
            3.0 * *std::max_element(without.begin(), without.end()));
}

// A scale of 1 um, noisy at that, is coarser than the error that there is: there is nothing to be won, and
// nothing may be lost.
TEST(LearningOnTheMachine, FiftyPassesWithNoiseStayBounded) {
  const Program circle = test::Circle(0.1, 2, 1.5);
  const std::vector<double> without = Passes(WithScales(false, "csp", "1000"), circle, 10);
  const std::vector<double> with = Passes(WithScales(true, "csp", "1000"), circle, 50);
  const double usual = *std::max_element(without.begin(), without.end());
  EXPECT_LT(*std::max_element(with.begin(), with.end()), usual + 0.5);
  EXPECT_LT(*std::max_element(with.end() - 10, with.end()), usual + 0.2);
}

}  // namespace
}  // namespace contour
