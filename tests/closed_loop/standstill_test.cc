#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/closed_loop/test_machine.h"

// Holding still is where a friction estimate learns nothing and can only go wrong: it must neither make the
// axis hunt nor be wrong when the axis moves again.
namespace contour::test {
namespace {

constexpr double kHeld_s = 30.0;
constexpr double kSettling_s = 10.0;

struct Standstill {
  double motor_pp_counts = 0.0;  ///< of the motor's true position: what the encoder would say without noise
  double resuming_peak_m = 0.0;  ///< at the table, from the first instant of a circle
};

Program Line(double dx_mm, double dy_mm) {
  return ParseProgram("{shape: line, dx_mm: " + std::to_string(dx_mm) + ", dy_mm: " + std::to_string(dy_mm) +
                          ", feed_mm_min: 3000}",
                      "line of the test", ProgramFormat::kYaml);
}

/// A random motion, then the drives are disabled and enabled, which starts the estimators anew with a
/// friction of zero while the true friction is whatever the motion left behind; a hold; a circle.
Standstill HoldAfterMotion(std::uint64_t seed) {
  EmulatedMachineFile file = ExampleMachine();
  file.emulator.seed = seed;
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  machine.Run(Line(15.0 * unit(random), 15.0 * unit(random)));
  machine.mailbox().Post(RequestKind::kDisable);
  for (int k = 0; k < 2000 && machine.record().state != MachineState::kIdle; ++k) machine.Tick();
  machine.Enable();

  Standstill result;
  double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
  const double count_m = 5e-3 / 1048576;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr || !machine.plan()) return;
    if (!machine.plan()->is_hold()) {
      PerAxis<double> table;
      for (const AxisTruth& a : truth->axes) table.push_back(a.table_position_m);
      result.resuming_peak_m = std::max(result.resuming_peak_m, machine.plan()->Distance_m(table));
      return;
    }
    if (r.path_time_s < kSettling_s) return;
    for (std::size_t i = 0; i < 2; ++i) {
      const double motor_m = truth->axes[i].motor_position_m;
      low[i] = std::min(low[i], motor_m);
      high[i] = std::max(high[i], motor_m);
      result.motor_pp_counts = std::max(result.motor_pp_counts, (high[i] - low[i]) / count_m);
    }
  });
  machine.Run(
      ParseProgram("{shape: hold, seconds: " + std::to_string(kHeld_s) + "}", "hold", ProgramFormat::kYaml));
  machine.Run(Circle(0.1, 1, 0.7853981634));
  return result;
}

TEST(Standstill, NoHuntingAndNoJumpAtTenPositions) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Standstill s = HoldAfterMotion(seed);
    EXPECT_LE(s.motor_pp_counts, 1.0) << "seed " << seed;
    EXPECT_LT(s.resuming_peak_m, 0.5e-6) << "seed " << seed;
  }
}

}  // namespace
}  // namespace contour::test
