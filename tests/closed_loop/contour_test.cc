#include <gtest/gtest.h>

#include <cmath>

#include "tests/closed_loop/test_machine.h"

namespace contour::test {
namespace {

const Program kSmall = Circle(0.1, 3, 0.7853981634);

TEST(Contour, CompensationBeatsThePlainMpcOnTheSmallCircle) {
  const EmulatedMachineFile file = ExampleMachine();
  const RunResult mpc = RunCircle(file, ControllerName::kMpc, kSmall);
  const RunResult full = RunCircle(file, ControllerName::kFull, kSmall);
  EXPECT_LT(full.circular_deviation_m() * 10.0, mpc.circular_deviation_m());
  EXPECT_LT(full.table_peak_m, 1.0e-6);
  EXPECT_LT(full.friction_rms_N(), 1.0);
}

TEST(Contour, ReversalsCorrectTheScrewsStiffness) {
  for (const std::string law : {"srukf", "linear"})
    for (const char* seed : {"emulator.seed=1", "emulator.seed=4"}) {
      const std::vector<std::string> set{seed, "control.friction=" + law};
      std::vector<std::string> as_stated = set;
      as_stated.push_back("estimator.stiffness_std=0");
      const double bound_m = law == "srukf" ? 0.3e-6 : 0.45e-6;
      EXPECT_LT(RunCircle(ExampleMachine(set), ControllerName::kFull, kSmall).table_peak_m, bound_m)
          << law << seed;
      EXPECT_GT(RunCircle(ExampleMachine(as_stated), ControllerName::kFull, kSmall).table_peak_m, bound_m)
          << law << seed;
    }
}

TEST(Contour, AndOnTheLargeCircle) {
  const Program large = Circle(10.0, 3, 0.7957747155);  // 3 m/min
  const RunResult mpc = RunCircle(ExampleMachine(), ControllerName::kMpc, large);
  const auto full = [&](const char* law) {
    return RunCircle(ExampleMachine({std::string("control.friction=") + law}), ControllerName::kFull, large);
  };
  const RunResult filter = full("srukf"), linear = full("linear");
  EXPECT_LT(filter.circular_deviation_m() * 20.0, mpc.circular_deviation_m());
  EXPECT_LT(linear.circular_deviation_m() * 12.0, mpc.circular_deviation_m());
  EXPECT_LT(filter.table_peak_m, 2.5e-6);
  EXPECT_LT(linear.table_peak_m, 2.5e-6);
}

TEST(Contour, TheSameRunTwiceIsTheSameRun) {
  const EmulatedMachineFile file = ExampleMachine();
  const RunResult a = RunCircle(file, ControllerName::kFull, kSmall);
  const RunResult b = RunCircle(file, ControllerName::kFull, kSmall);
  EXPECT_EQ(a.torque_Nm, b.torque_Nm);
  EmulatedMachineFile other = file;
  other.emulator.seed = 77;
  EXPECT_NE(a.torque_Nm, RunCircle(other, ControllerName::kFull, kSmall).torque_Nm);
}

TEST(Contour, WithoutFrictionCompensationDoesNoHarm) {
  std::vector<std::string> none;
  for (const char* axis : {"x", "y"})
    for (const char* key : {"Fs_plus_N", "Fs_minus_N", "Fc_plus_N", "Fc_minus_N"})
      none.push_back(std::string("emulator.axes.") + axis + ".friction." + key + "=0");
  const Program programs[] = {kSmall, Circle(0.1, 2, 0.125), Circle(10.0, 3, 0.7957747155)};
  // What is fed forward until the first reversals have taught the other law that there is none: of the 0.9 um
  // by which the friction that is stated winds the screw up.
  constexpr double kUntilLearnt_m = 0.15e-6;
  // On the small circles only the encoder's steps and the drive's torque steps are left, and the largest of
  // thousands of samples is chance: one count of the encoder (5 mm / 2^20) is no difference.
  constexpr double kCount_m = 5e-3 / 1048576;
  for (const char* seed : {"1", "2", "3"}) {
    std::vector<std::string> with_seed = none;
    with_seed.push_back(std::string("emulator.seed=") + seed);
    const EmulatedMachineFile linear = ExampleMachine(with_seed);
    with_seed.push_back("control.friction=srukf");
    const EmulatedMachineFile filter = ExampleMachine(with_seed);
    for (const Program& program : programs) {
      const double mpc_m = RunCircle(filter, ControllerName::kMpc, program).table_peak_m;
      EXPECT_LE(RunCircle(filter, ControllerName::kFull, program).table_peak_m, mpc_m + kCount_m)
          << "seed " << seed;
      EXPECT_LE(RunCircle(linear, ControllerName::kFull, program).table_peak_m, mpc_m + kUntilLearnt_m)
          << "seed " << seed;
    }
  }
}

TEST(Contour, TheTorqueOffsetHelpsTheDrivesOwnCascade) {
  const Program large = Circle(10.0, 2, 0.7957747155);
  const RunResult plain = RunCircle(ExampleMachine(), ControllerName::kCsp, large);
  const RunResult offset =
      RunCircle(ExampleMachine({"control.csp.torque_offset=true"}), ControllerName::kCsp, large);
  for (const double torque : plain.torque_Nm) ASSERT_EQ(torque, 0.0);
  // What the table's and motor's mass take at 0.25 m/s^2 along: 22 N.
  EXPECT_GT(*std::max_element(offset.torque_Nm.begin(), offset.torque_Nm.end()), 0.015);
  EXPECT_NE(offset.table_peak_m, plain.table_peak_m);
}

TEST(Contour, AFrozenEstimatorIsVisiblyWorse) {
  const RunResult live = RunCircle(ExampleMachine(), ControllerName::kFull, kSmall);
  // Frozen: friction is what was commissioned, whatever the machine does.
  const RunResult frozen = RunCircle(ExampleMachine({"estimator.adapt=false", "estimator.bristle_noise_rel=0",
                                                     "estimator.disturbance_noise_mm_s2=0"}),
                                     ControllerName::kFull, kSmall);
  EXPECT_GT(frozen.table_peak_m, 2.0 * live.table_peak_m);
}

/// The estimator of x on a recorded run, once with x's own torque and once with y's.
TEST(Contour, AnEstimatorFedTheOtherAxisTorqueIsVisiblyWorse) {
  const EmulatedMachineFile file = ExampleMachine();
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  const AxisConfig& x = file.machine.axes.at("x");
  const Mechanics mechanics = ToSi(x.model.mechanics);
  const auto make = [&] {
    return AxisEstimator(EstimatorKind::kFull, mechanics, x.model.friction, file.machine.estimator, 1e-3,
                         x.drive.lag_ms * 1e-3);
  };
  AxisEstimator own = make();
  AxisEstimator other = make();
  own.Reset(machine.record().axes[0].position_m);
  other.Reset(machine.record().axes[0].position_m);
  std::array<std::array<double, 3>, 2> sent{};
  double own_square = 0.0, other_square = 0.0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    if (truth == nullptr) return;
    AxisEstimatorInput in;
    in.position_m = r.axes[0].position_m;
    in.fresh = true;
    in.commanded_velocity_m_s = r.axes[0].reference.velocity_m_s;
    in.commanded_acceleration_m_s2 = r.axes[0].reference.acceleration_m_s2;
    in.at_rest = in.commanded_velocity_m_s == 0.0;
    in.enabled = true;
    in.force_N = sent[0];
    const double friction = truth->axes[0].friction_N;
    own_square += std::pow(own.Update(in).friction_N - friction, 2);
    in.force_N = sent[1];
    other_square += std::pow(other.Update(in).friction_N - friction, 2);
    for (std::size_t i = 0; i < 2; ++i)
      sent[i] = {r.axes[i].torque_Nm / mechanics.radius_m_rad, sent[i][0], sent[i][1]};
  });
  machine.Run(kSmall);
  EXPECT_GT(std::sqrt(other_square), 10.0 * std::sqrt(own_square));
}

}  // namespace
}  // namespace contour::test
