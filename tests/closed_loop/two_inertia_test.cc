#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "config/loop_axis.h"
#include "daemon/make_cycle_config.h"
#include "daemon/rt/cycle.h"
#include "tests/closed_loop/test_machine.h"
#include "tests/support/allocation_guard.h"

// `full` with control.friction: linear: motor and table known apart, friction learnt along the reference.
namespace contour::test {
namespace {

/// One tuning for tables of 10 to 50 kg; no axis's own.
constexpr const char* kLoop =
    "{regulator_Hz: 20, windup_weight: 0.4, velocity_weight: 0.18, disturbance_Hz: 200, motor_force_Hz: 400, "
    "table_force_Hz: 400, notch_ratio: 0.77, notch_pole_damping: 0.7, notch_zero_damping: 0.3}";

/// The example with another table, the model as far off as it is for its own; 0: its own.
std::vector<std::string> Linear(const std::string& mode, double table_kg = 0.0) {
  std::vector<std::string> set{"control.friction=linear"};
  for (const std::string axis : {"x", "y"}) {
    const std::string key = "axes." + axis + ".";
    set.push_back(key + "loop=" + kLoop);
    set.push_back(key + "drive.mode=" + mode);
    if (table_kg == 0.0) continue;
    set.push_back("emulator.axes." + axis + ".table_mass_kg=" + std::to_string(table_kg));
    set.push_back(key + "model.table_mass_kg=" + std::to_string(table_kg * (axis == "x" ? 1.06 : 0.94)));
    // A heavier axis takes longer to stop.
    set.push_back(key + "drive.quick_stop_deceleration_rad_s2=15000");
    set.push_back(key + "limits.safe_travel_mm=3");
  }
  return set;
}

// F / K of the example's axes.
constexpr double kWindUp_m = 1.1e-6;

TEST(TwoInertia, DrawsTheSmallCircleWithTablesThatOneInertiaLoses) {
  for (const double table_kg : {0.0, 22.0, 30.0, 50.0}) {
    const RunResult r =
        RunCircle(ExampleMachine(Linear("cst", table_kg)), ControllerName::kFull, Circle(0.1, 4, 0.7854));
    EXPECT_LT(r.table_peak_m, 0.4 * kWindUp_m) << table_kg;
  }
}

TEST(TwoInertia, DrawsTheLargeCircle) {
  for (const double table_kg : {0.0, 22.0, 50.0}) {
    const RunResult r =
        RunCircle(ExampleMachine(Linear("cst", table_kg)), ControllerName::kFull, Circle(5.0, 4, 1.5915));
    EXPECT_LT(r.table_peak_m, 1.1 * kWindUp_m) << table_kg;
  }
}

TEST(TwoInertia, WorksWhereTheDriveClosesTheLoop) {
  for (const double table_kg : {0.0, 50.0}) {
    const RunResult r =
        RunCircle(ExampleMachine(Linear("csp", table_kg)), ControllerName::kFull, Circle(0.1, 4, 0.7854));
    EXPECT_LT(r.table_peak_m, 0.4 * kWindUp_m) << table_kg;
  }
}

// A bristle stiffness learnt in corners once let `srukf` swing there by 1.5 um for good, with seed 2.
TEST(TwoInertia, StandsStillAfterASquare) {
  const Program square = ParseProgram(
      "{sequence: [{shape: square, side_mm: 10, feed_mm_min: 3000, turns: 4, corners: velocity_jump}, "
      "{shape: hold, seconds: 6}]}",
      "square of the test", ProgramFormat::kYaml);
  for (const std::uint64_t seed : {2u, 3u}) {
    for (const std::string mode : {"cst", "csp"}) {
      std::vector<std::string> set = Linear(mode);
      set.push_back("emulator.seed=" + std::to_string(seed));
      VirtualMachine machine(ExampleMachine(set), ControllerName::kFull);
      machine.BringUp();
      machine.Enable();
      std::vector<std::array<double, 2>> table_m;
      machine.SetObserver([&](const CycleEntry&, const TruthRow* truth) {
        if (truth != nullptr)
          table_m.push_back({truth->axes[0].table_position_m, truth->axes[1].table_position_m});
      });
      machine.Run(square);
      ASSERT_GT(table_m.size(), 3000u);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        double low = 1.0, high = -1.0;
        for (std::size_t k = table_m.size() - 3000; k < table_m.size(); ++k) {
          low = std::min(low, table_m[k][axis]);
          high = std::max(high, table_m[k][axis]);
        }
        EXPECT_LT(high - low, 0.1e-6) << mode << " " << seed << " " << axis;
      }
    }
  }
}

// Three tenths of the friction at the motor, K as it is. In torque mode the loop has it on the motor, too.
TEST(TwoInertia, FrictionBeforeTheScrewIsTheMotors) {
  std::vector<std::string> set = Linear("cst");
  for (const std::string axis : {"x", "y"}) {
    set.push_back("emulator.axes." + axis + ".friction.motor_share_rel=0.3");
    set.push_back("axes." + axis + ".model.screw_stiffness_N_um=40");
  }
  const Program circle = Circle(0.1, 4, 0.7854);
  const double unknown_m = RunCircle(ExampleMachine(set), ControllerName::kFull, circle).table_peak_m;
  for (const std::string axis : {"x", "y"})
    set.push_back("axes." + axis + ".model.friction.motor_share_rel=0.3");
  const double known_m = RunCircle(ExampleMachine(set), ControllerName::kFull, circle).table_peak_m;
  EXPECT_LT(known_m, 0.9 * unknown_m);
}

/// Share of the scored cycles in which friction is within two of its stated deviations.
double FrictionInside_rel(const EmulatedMachineFile& file, const Program& program) {
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  double inside = 0.0, all = 0.0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (r.state != MachineState::kRunning || truth == nullptr || !machine.plan()) return;
    if (!machine.plan()->Scored(r.path_time_s)) return;
    for (std::size_t i = 0; i < r.axes.size(); ++i) {
      const AxisEstimate& e = r.axes[i].estimate;
      inside += std::abs(e.friction_N - truth->axes[i].friction_N) < 2.0 * e.friction_std_N ? 1.0 : 0.0;
      all += 1.0;
    }
  });
  machine.Run(program);
  return all > 0.0 ? inside / all : 0.0;
}

// A workpiece of twice the table, two of the stated deviations: what accelerates it is no friction.
TEST(TwoInertia, TheBandOfFrictionHoldsAMassThatIsNotAsStated) {
  std::vector<std::string> set = Linear("cst");
  set.push_back("estimator.mass_std=0.1");
  for (const std::string axis : {"x", "y"}) set.push_back("emulator.axes." + axis + ".table_mass_kg=30");
  EXPECT_GT(FrictionInside_rel(ExampleMachine(set), Circle(5.0, 4, 1.0)), 0.9);
}

TEST(TwoInertia, TheLoopThatRunsIsTheOneThatIsJudged) {
  std::vector<std::string> set = Linear("cst");
  set.push_back("axes.x.model.extensions={input_delay: {delay_us: 60}, current_lag: {time_constant_us: 50}}");
  const EmulatedMachineFile file = ExampleMachine(set);
  const CycleConfig config = MakeCycleConfig(file.machine, ControllerName::kFull);
  EXPECT_EQ(config.axes[0].two_inertia, LoopAxisOf(file.machine.axes.at("x")).axis);
  EXPECT_NEAR(config.axes[0].two_inertia.dead_time_s, 60e-6, 1e-12);
  EXPECT_NEAR(config.axes[0].two_inertia.lag_s, 250e-6, 1e-12);
}

// What has been learnt is in the state, and nothing beside it.
TEST(TwoInertia, GoesOnFromASavedStateBitForBit) {
  const EmulatedMachineFile file = ExampleMachine(Linear("cst"));
  VirtualMachine machine(file, ControllerName::kFull);
  std::vector<CycleInput> inputs;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) { inputs.push_back(entry.input); });
  machine.BringUp();
  machine.Enable();
  machine.Run(Circle(0.1, 1, 2.0));
  const CycleConfig config = MakeCycleConfig(file.machine, ControllerName::kFull);
  Cycle first(config), second(config);
  auto out = std::make_unique<CycleOutput>();
  const std::size_t middle = inputs.size() - 300;
  for (std::size_t k = 0; k < middle; ++k) first.Step(inputs[k], *out);
  std::vector<std::byte> state(first.StateSize());
  first.SaveState(state);
  ASSERT_TRUE(second.LoadState(state));
  auto other = std::make_unique<CycleOutput>();
  for (std::size_t k = middle; k < inputs.size(); ++k) {
    const AllocationGuard guard;
    first.Step(inputs[k], *out);
    EXPECT_EQ(guard.calls(), 0u);
    second.Step(inputs[k], *other);
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_EQ(out->record.axes[i].torque_Nm, other->record.axes[i].torque_Nm) << k;
      ASSERT_EQ(out->record.axes[i].estimate.friction_N, other->record.axes[i].estimate.friction_N) << k;
    }
  }
}

}  // namespace
}  // namespace contour::test
