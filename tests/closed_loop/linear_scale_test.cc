#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/closed_loop/test_machine.h"

// `full` with control.friction: linear on axes with a linear scale: what is drawn is where the table is.
namespace contour::test {
namespace {

/// The example with scales of 5 nm, in torque mode with them in its loops; `stiffness_N_um`: as believed,
/// of 40.
std::vector<std::string> Scaled(const std::string& mode, bool scale, const std::string& stiffness_N_um) {
  std::vector<std::string> set{"control.friction=linear", "realtime.send_deadline_us=70"};
  for (const std::string axis : {"x", "y"}) {
    const std::string key = "axes." + axis + ".";
    set.push_back(key + "drive.mode=" + mode);
    set.push_back(key + "model.screw_stiffness_N_um=" + stiffness_N_um);
    set.push_back(key +
                  "loop={regulator_Hz: 20, windup_weight: 0.4, velocity_weight: 0.18, disturbance_Hz: 200, "
                  "motor_force_Hz: 400, table_force_Hz: 400, notch_ratio: 0.77, notch_pole_damping: 0.7, "
                  "notch_zero_damping: 0.3}");
    if (!scale) continue;
    set.push_back(key + "drive.linear_scale={counts_per_mm: 200000}");
    set.push_back(
        key +
        "scale_loop={regulator_Hz: 32.4, windup_weight: 0.47, velocity_weight: 0.08, disturbance_Hz: 345, "
        "motor_force_Hz: 452, table_force_Hz: 1048, notch_ratio: 1.48, notch_pole_damping: 0.13, "
        "notch_zero_damping: 0.29, scale_noise_ratio: 0.12, bias_Hz: 151.4}");
  }
  return set;
}

double Peak_m(const std::string& mode, bool scale, const std::string& stiffness_N_um,
              const Program& program) {
  return RunCircle(ExampleMachine(Scaled(mode, scale, stiffness_N_um)), ControllerName::kFull, program)
      .table_peak_m;
}

TEST(LinearScale, HalvesWhatIsLeftOfCirclesInTorqueMode) {
  for (const std::string stiffness : {"36", "28"})
    EXPECT_LT(Peak_m("cst", true, stiffness, Circle(0.1, 4, 0.7854)),
              0.5 * Peak_m("cst", false, stiffness, Circle(0.1, 4, 0.7854)))
        << stiffness;
  EXPECT_LT(Peak_m("cst", true, "36", Circle(5.0, 4, 1.5915)),
            0.9 * Peak_m("cst", false, "36", Circle(5.0, 4, 1.5915)));
}

TEST(LinearScale, MakesUpForAStiffnessThatIsOffWhereTheDriveClosesTheLoop) {
  for (const std::string stiffness : {"28", "52"})
    EXPECT_LT(Peak_m("csp", true, stiffness, Circle(0.1, 4, 0.7854)),
              0.6 * Peak_m("csp", false, stiffness, Circle(0.1, 4, 0.7854)))
        << stiffness;
}

/// How far the table is from its reference at most, on the shipped single axis; 1 m: the run ended in a
/// fault.
double SineMiss_m(const std::string& mode, double counts_per_mm, int seed) {
  std::vector<std::string> set{"axes.x.drive.mode=" + mode, "emulator.seed=" + std::to_string(seed)};
  if (counts_per_mm > 0.0)
    set.push_back("axes.x.drive.linear_scale={counts_per_mm: " + std::to_string(counts_per_mm) + "}");
  VirtualMachine machine(LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml", set),
                         ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  double miss_m = 0.0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr) return;
    miss_m = std::max(miss_m, std::abs(truth->axes[0].table_position_m - r.axes[0].reference.position_m));
  });
  try {
    machine.Run(ParseProgram(
        "{sequence: [{shape: sine, axis: x, amplitude_mm: 5, feed_mm_min: 1200}, {shape: hold, seconds: 2}]}",
        "sine of the test", ProgramFormat::kYaml));
  } catch (const std::runtime_error&) {
    return 1.0;
  }
  return miss_m;
}

// Before: steps of the scale were learnt as a lead, a zero that was to make up for it ran away, and 5 um took
// the table 0.3 to 0.5 mm from its path, or the run to a fault.
TEST(LinearScale, OneThatCountsCoarselyKeepsTheTableWithinItsCounts) {
  constexpr double kCounts = 2.0, kAsWithout = 1.5;
  for (const std::string mode : {"cst", "csp"})
    for (const int seed : {1, 3}) {
      const double without_m = SineMiss_m(mode, 0.0, seed);
      for (const double counts_per_mm : {200.0, 1000.0})
        EXPECT_LT(SineMiss_m(mode, counts_per_mm, seed),
                  std::max(kCounts * 1e-3 / counts_per_mm, kAsWithout * without_m))
            << mode << ' ' << counts_per_mm << ' ' << seed;
    }
}

}  // namespace
}  // namespace contour::test
