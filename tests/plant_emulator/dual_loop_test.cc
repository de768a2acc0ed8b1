// What drives as sold have beside the plain cascade: a notch on the torque command, and a position loop that
// is closed on a linear scale.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/plant_emulator/drive_harness.h"
#include "tools/plant_emulator/drive_cascade.h"
#include "tools/plant_emulator/notch_filter.h"

namespace contour::plant {
namespace {

constexpr double kTick_s = 125e-6;
constexpr std::int32_t kStep = 210;  ///< counts per cycle: 1 mm/s

double Gain(double width, double depth, double at_Hz) {
  NotchFilter notch(200.0, width, depth, kTick_s);
  double largest = 0.0;
  for (int i = 0; i < 16000; ++i) {
    const double out = notch.Step(std::sin(2.0 * std::numbers::pi * at_Hz * kTick_s * i));
    if (i > 8000) largest = std::max(largest, std::fabs(out));
  }
  return largest;
}

TEST(NotchFilter, LeavesItsDepthInTheMiddleAndAllFarAway) {
  EXPECT_NEAR(Gain(0.5, 0.1, 200.0), 0.1, 1e-3);
  EXPECT_NEAR(Gain(0.2, 0.4, 200.0), 0.4, 1e-3);
  EXPECT_NEAR(Gain(0.5, 0.1, 2.0), 1.0, 1e-3);
  EXPECT_NEAR(Gain(0.1, 0.1, 1500.0), 1.0, 0.03);
  // Half a width beside the middle: |1 - x^2 + 2i depth width x| / |1 - x^2 + 2i width x|, x prewarped.
  const double x =
      std::tan(std::numbers::pi * 300.0 * kTick_s) / std::tan(std::numbers::pi * 200.0 * kTick_s);
  EXPECT_NEAR(Gain(0.5, 0.1, 300.0), std::hypot(1 - x * x, 0.1 * x) / std::hypot(1 - x * x, x), 2e-3);
}

TEST(NotchFilter, WithoutAFrequencyItIsNotThere) {
  NotchFilter none(0.0, 0.5, 0.1, kTick_s);
  EXPECT_EQ(none.Step(0.3), 0.3);
  EXPECT_EQ(none.Step(-7.0), -7.0);
}

EmulatorConfig OneAxis(double dual_loop_Hz) {
  EmulatorConfig c;
  c.parameter_variation_rel = 0.0;
  c.axes["x"] = test::NominalAxis();
  c.axes["x"].start_variation_mm = 0.0;
  c.axes["x"].cascade.dual_loop_Hz = dual_loop_Hz;
  c.axes["x"].scale_counts_per_mm = 1e5;  // 10 nm
  return c;
}

/// How far the table is behind the target while it creeps in one direction, um.
double Behind_um(double dual_loop_Hz, int direction) {
  test::DriveHarness h(OneAxis(dual_loop_Hz), {test::Place("x", 1)});
  h.BringUp(8);
  h.Enable(4);
  const double count_m = 5e-3 / 1048576.0;
  std::int32_t target = h.position(1);
  double sum_m = 0.0;
  int summed = 0;
  for (int i = 0; i < 4000; ++i) {
    target += direction * kStep;
    h.Cycle(0x0F, target, 4);
    if (i < 3000) continue;
    // The drive runs half a period behind its targets, and a SYNC has gone by since.
    const double wanted_m = count_m * (target - 1.5 * direction * kStep);
    sum_m += wanted_m - h.machine.truth().axes[0].table_position_m;
    ++summed;
  }
  return 1e6 * sum_m / summed;
}

TEST(DualLoop, TheTableIsOnTheTargetInBothDirections) {
  // Between the directions the motor's encoder leaves the wind-up, 2 F / K with about 50 N and 40 N/um.
  const double motor_um = Behind_um(0.0, 1) - Behind_um(0.0, -1);
  const double scale_um = Behind_um(30.0, 1) - Behind_um(30.0, -1);
  EXPECT_GT(motor_um, 1.7);
  EXPECT_LT(motor_um, 3.0);
  EXPECT_LT(std::fabs(scale_um), 0.1);
}

TEST(DualLoop, NeedsAScale) {
  EmulatorConfig c = OneAxis(30.0);
  c.axes["x"].scale_counts_per_mm = std::nullopt;
  EXPECT_THROW(test::DriveHarness(c, {test::Place("x", 1)}), std::invalid_argument);
}

}  // namespace
}  // namespace contour::plant
