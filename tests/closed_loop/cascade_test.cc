#include <gtest/gtest.h>

#include "daemon/make_cycle_config.h"
#include "tests/closed_loop/test_machine.h"

namespace contour::test {
namespace {

// `full` on drives that close their own position loop.

const Program kSmall = Circle(0.1, 5, 0.7853981634);
const Program kLarge = Circle(10.0, 4, 0.7957747155);  // 3 m/min

std::vector<std::string> InCascade(std::vector<std::string> more = {}) {
  more.insert(more.end(), {"axes.x.drive.mode=csp", "axes.y.drive.mode=csp"});
  return more;
}

std::vector<std::string> OnBoth(const std::vector<std::string>& keys) {
  std::vector<std::string> out;
  for (const char* axis : {"x", "y"})
    for (const std::string& key : keys) out.push_back(std::string("emulator.axes.") + axis + "." + key);
  return out;
}

TEST(FullInCascade, BeatsTheDrivesOwnCascade) {
  const EmulatedMachineFile file = ExampleMachine(InCascade());
  for (const Program& program : {kSmall, kLarge}) {
    const RunResult alone = RunCircle(file, ControllerName::kCsp, program);
    const RunResult full = RunCircle(file, ControllerName::kFull, program);
    EXPECT_LT(2.0 * full.table_peak_m, alone.table_peak_m);
    EXPECT_LT(full.table_peak_m, 0.7e-6);
  }
}

// What swung when the friction that was not foreseen was fed forward beside the drive's own answer to it.
TEST(FullInCascade, AWrongModelDoesNotMakeItSwing) {
  const std::vector<std::vector<std::string>> machines{
      OnBoth({"motor_inertia_kgm2=3.5e-5", "table_mass_kg=7"}),
      OnBoth({"motor_inertia_kgm2=6.5e-5", "table_mass_kg=13"}), OnBoth({"screw_stiffness_N_um=20"}),
      OnBoth({"delay_cycles=2"})};
  for (const auto& machine : machines) {
    const EmulatedMachineFile file = ExampleMachine(InCascade(machine));
    EXPECT_LT(RunCircle(file, ControllerName::kFull, kLarge).table_peak_m, 2.5e-6) << machine.front();
  }
}

// At 10 m/min presliding is over within two reports of the torque. What sigma0 took up there was the wrong
// mass: it went up turn by turn, to 1.6 times what it was after three, as did the error.
TEST(FullInCascade, Sigma0DoesNotTakeUpAWrongMass) {
  std::vector<std::string> heavier = OnBoth({"motor_inertia_kgm2=6.5e-5", "table_mass_kg=13"});
  heavier.emplace_back("emulator.seed=3");
  VirtualMachine machine(ExampleMachine(InCascade(heavier)), ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  std::vector<double> sigma0_N_m;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    const CycleRecord& r = entry.output.record;
    if (r.state == MachineState::kRunning) sigma0_N_m.push_back(r.axes[1].estimate.sigma0_N_m);
  });
  const double frequency_hz = 2.6525823849;
  const int turns = 27;
  machine.Run(Circle(10.0, turns, frequency_hz));
  const auto three_turns = static_cast<std::size_t>(3.0 / frequency_hz * 1e3);
  ASSERT_GT(sigma0_N_m.size(), 8 * three_turns);
  EXPECT_LT(sigma0_N_m.back(), 1.1 * sigma0_N_m.at(three_turns));
}

TEST(FullInCascade, AStepOfCuttingForceCostsLessThanWithTorquesFromHere) {
  const std::vector<std::string> force = OnBoth({"effects.cutting_force={force_N: 60, start_s: 3}"});
  const RunResult from_here = RunCircle(ExampleMachine(force), ControllerName::kFull, kLarge);
  const RunResult cascade = RunCircle(ExampleMachine(InCascade(force)), ControllerName::kFull, kLarge);
  EXPECT_LT(2.0 * cascade.table_peak_m, from_here.table_peak_m);
}

/// Largest contour error at the encoder, square with rounded corners, m.
double SquarePeak_m(const std::vector<std::string>& machine) {
  VirtualMachine one(ExampleMachine(InCascade(machine)), ControllerName::kFull);
  one.BringUp();
  one.Enable();
  double peak_m = 0.0;
  one.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    peak_m = std::max(peak_m, std::abs(entry.output.record.contour_error_m));
  });
  one.Run(ParseProgram("{shape: square, side_mm: 10, feed_mm_min: 3000, corner_tolerance_mm: 0.005}",
                       "square", ProgramFormat::kYaml));
  return peak_m;
}

TEST(FullInCascade, ADriveWithoutAccelerationFeedForwardIsMadeUpFor) {
  const std::vector<std::string> without = OnBoth({"cascade.acceleration_feedforward=0"});
  std::vector<std::string> given = without;
  for (const char* axis : {"x", "y"})
    given.push_back(std::string("axes.") + axis + ".drive.csp_acceleration_share=1");
  const double with_m = SquarePeak_m({}), without_m = SquarePeak_m(without), given_m = SquarePeak_m(given);
  EXPECT_LT(given_m, 1.1 * with_m);
  EXPECT_GT(without_m, 1.3 * given_m);
}

// Three tenths of the friction at the motor: what it bears does not wind the screw up. The screw is known.
TEST(FullInCascade, FrictionBeforeTheScrewIsNoWindUp) {
  for (const std::string law : {"srukf", "linear"}) {
    std::vector<std::string> set = InCascade(OnBoth({"friction.motor_share_rel=0.3"}));
    set.push_back("control.friction=" + law);
    for (const char* axis : {"x", "y"})
      set.push_back(std::string("axes.") + axis + ".model.screw_stiffness_N_um=40");
    const double unknown_m = RunCircle(ExampleMachine(set), ControllerName::kFull, kSmall).table_peak_m;
    for (const char* axis : {"x", "y"})
      set.push_back(std::string("axes.") + axis + ".model.friction.motor_share_rel=0.3");
    const double known_m = RunCircle(ExampleMachine(set), ControllerName::kFull, kSmall).table_peak_m;
    EXPECT_GT(unknown_m, 0.2e-6) << law;
    EXPECT_LT(2.5 * known_m, unknown_m) << law;
  }
}

TEST(FullInCascade, OnlyFullTakesTheModeOfTheMachineFile) {
  const MachineConfig machine = ExampleMachine(InCascade()).machine;
  for (const AxisDriveConfig& axis : MakeCycleConfig(machine, ControllerName::kFull).master.axes)
    EXPECT_EQ(axis.drive.mode, DriveMode::kCsp);
  for (const AxisDriveConfig& axis : MakeCycleConfig(machine, ControllerName::kMpcSrukf7).master.axes)
    EXPECT_EQ(axis.drive.mode, DriveMode::kCst);
}

}  // namespace
}  // namespace contour::test
