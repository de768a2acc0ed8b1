#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/closed_loop/test_machine.h"

namespace contour::test {
namespace {

Program Text(const std::string& text) { return ParseProgram(text, "test.yaml", ProgramFormat::kYaml); }

/// Extremes of the x axis over a program.
struct Seen {
  double furthest_m = 0.0;      ///< from where the program began, at the encoder
  double largest_Nm = 0.0;      ///< torque sent
  double unaccounted_Nm = 0.0;  ///< wanted torque less controller's and extra torque of the row
  double friction_off_N = 0.0;  ///< estimate against truth, rms while the axis was pushed
  double end_error_m = 0.0;
  bool sprung = false;
};

Seen Observe(const EmulatedMachineFile& file, ControllerName controller, const std::string& text) {
  VirtualMachine machine(file, controller);
  machine.BringUp();
  machine.Enable();
  Seen seen;
  double square = 0.0;
  int rows = 0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& r = entry.output.record;
    const AxisRecord& a = r.axes[0];
    if (r.state != MachineState::kRunning || truth == nullptr) return;
    seen.furthest_m = std::max(seen.furthest_m, std::abs(a.following_error_m));
    seen.largest_Nm = std::max(seen.largest_Nm, std::abs(a.torque_Nm));
    seen.sprung = seen.sprung || a.reference.spring_N_m > 0.0;
    if (a.reference.extra_torque_Nm != 0.0) {
      const double off = a.estimate.friction_N - truth->axes[0].friction_N;
      square += off * off;
      ++rows;
    }
  });
  machine.Run(Text(text));
  for (int i = 0; i < 300; ++i) machine.Tick();
  seen.end_error_m = std::abs(machine.record().axes[0].following_error_m);
  seen.friction_off_N = rows > 0 ? std::sqrt(square / rows) : 0.0;
  return seen;
}

const std::string kSteps =
    "{shape: torque_steps, axis: x, travel_mm: 0.3, torques_Nm: [0.02, -0.02, 0.055, -0.055]}";

TEST(TorqueExperiments, StepsBreakAwayWithinTheStatedTravelUnderEveryController) {
  for (const ControllerName name : {ControllerName::kPid, ControllerName::kMpc, ControllerName::kFull}) {
    const Seen seen = Observe(ExampleMachine(), name, kSteps);
    EXPECT_TRUE(seen.sprung);
    // Friction is 42 N, the largest torque 69 N: it breaks away, and the spring holds it.
    EXPECT_GT(seen.furthest_m, 30e-6) << Name(name);
    EXPECT_LT(seen.furthest_m, 0.3e-3) << Name(name);
    // MPC alone has no integral action.
    EXPECT_LT(seen.end_error_m, name == ControllerName::kMpc ? 60e-6 : 2e-6)
        << Name(name) << ": the controller has taken over again";
  }
}

TEST(TorqueExperiments, TheSpringHoldsEvenWithoutFriction) {
  const EmulatedMachineFile file =
      ExampleMachine({"emulator.axes.x.friction.Fs_plus_N=0.5", "emulator.axes.x.friction.Fs_minus_N=0.5",
                      "emulator.axes.x.friction.Fc_plus_N=0.5", "emulator.axes.x.friction.Fc_minus_N=0.5"});
  const Seen seen = Observe(file, ControllerName::kPid, kSteps);
  EXPECT_GT(seen.furthest_m, 0.2e-3);
  EXPECT_LT(seen.furthest_m, 0.3e-3 * 1.02);
}

TEST(TorqueExperiments, SmallStepsDoNotBreakAway) {
  const Seen seen = Observe(ExampleMachine(), ControllerName::kFull,
                            "{shape: torque_steps, axis: x, travel_mm: 0.3, torques_Nm: [0.01, -0.01]}");
  EXPECT_LT(seen.furthest_m, 8e-6);
}

/// How far the x axis goes from its place while steps of torque hold it by a spring, with a force of 60 N on
/// its table that came when it was enabled: without a brake it would not wait for that.
double GivesWay_m(ControllerName controller, const std::vector<std::string>& stated) {
  std::vector<std::string> set{"emulator.axes.x.effects.cutting_force={force_N: 60, start_s: 2, lag_ms: 50}"};
  set.insert(set.end(), stated.begin(), stated.end());
  VirtualMachine machine(ExampleMachine(set), controller);
  machine.BringUp();
  machine.Enable();
  while (machine.record().cycle < 3500) machine.Tick();
  double furthest_m = 0.0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    const CycleRecord& r = entry.output.record;
    if (r.state == MachineState::kRunning && r.axes[0].reference.spring_N_m > 0.0)
      furthest_m = std::max(furthest_m, std::abs(r.axes[0].following_error_m));
  });
  machine.Run(Text("{shape: torque_steps, axis: x, travel_mm: 0.3, torques_Nm: [0.03, -0.03]}"));
  return furthest_m;
}

// The spring is of 1.3e5 N/m, friction of 42 N: with the largest step a weight that is not known takes the
// axis 0.4 mm away.
TEST(TorqueExperiments, AStatedWeightIsLedWhileTheSpringHolds) {
  const double radius_m = ToSi(ExampleMachine().machine.axes.at("x").model.mechanics).radius_m_rad;
  const std::string torque = std::to_string(60.0 * radius_m);
  const std::string spring =
      "axes.x.model.extensions.cable_spring={position_mm: [-1000, 1000], torque_Nm: [" + torque + ", " +
      torque + "]}";
  const std::string constant = "axes.x.model.extensions.constant_torque={torque_Nm: " + torque + "}";
  for (const ControllerName name : {ControllerName::kPid, ControllerName::kFull}) {
    const double unstated_m = GivesWay_m(name, {});
    EXPECT_GT(unstated_m, 0.2e-3) << Name(name) << ": it matters";
    for (const std::string& stated : {spring, constant})
      EXPECT_LT(GivesWay_m(name, {stated}), 0.2 * unstated_m) << Name(name) << " " << stated;
  }
}

TEST(TorqueExperiments, PulsesAreSentAndTheEstimatorKnowsThem) {
  const std::string pulses =
      "{shape: creep, axis: x, stroke_mm: 20, velocities_mm_s: [20], "
      "torque: {axis: x, kind: pulses, amplitude_Nm: 0.2, width_s: 0.004, period_s: 0.25}}";
  const Seen seen = Observe(ExampleMachine(), ControllerName::kFull, pulses);
  EXPECT_GT(seen.largest_Nm, 0.2);
  // 0.2 Nm are 250 N: an estimator that did not know of them would book hundreds of newtons as friction. One
  // that does is 10 to 32 N off, depending on the seed and on last digits.
  EXPECT_LT(seen.friction_off_N, 45.0);
}

TEST(TorqueExperiments, TheGuardHoldsTheSumWithinTheLimit) {
  const Seen seen = Observe(
      ExampleMachine({"axes.x.limits.torque_Nm=0.7", "axes.x.drive.quick_stop_deceleration_rad_s2=11000"}),
      ControllerName::kMpc,
      "{shape: creep, axis: x, stroke_mm: 20, velocities_mm_s: [20], "
      "torque: {axis: x, kind: pulses, amplitude_Nm: 0.69, width_s: 0.004, period_s: 0.25}}");
  EXPECT_GT(seen.largest_Nm, 0.69);
  EXPECT_LE(seen.largest_Nm, 0.7 + 0.0007) << "and half a per mille of rated torque";
}

TEST(TorqueExperiments, AStopAndAFollowingErrorStillWork) {
  const EmulatedMachineFile file = ExampleMachine();
  VirtualMachine machine(file, ControllerName::kFull);
  machine.BringUp();
  machine.Enable();
  int ticks = 0;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow*) {
    if (entry.output.record.state == MachineState::kRunning && ++ticks == 1500) machine.mailbox().PostStop();
  });
  EXPECT_THROW(machine.Run(Text(kSteps)), std::runtime_error);
  for (int i = 0; i < 400; ++i) machine.Tick();
  EXPECT_EQ(machine.record().state, MachineState::kReady);
  EXPECT_EQ(machine.record().reason, Reason::kOperatorStop);
  EXPECT_EQ(machine.record().axes[0].reference.extra_torque_Nm, 0.0);
  EXPECT_LT(std::abs(machine.record().axes[0].following_error_m), 2e-6);

  // A cutting force that nobody stated pushes the sprung axis away: the guard sees it.
  VirtualMachine pushed(
      ExampleMachine({"emulator.axes.x.effects.cutting_force={force_N: 400, start_s: 2}",
                      "axes.x.limits.external_force_N=500", "axes.x.limits.safe_travel_mm=3"}),
      ControllerName::kFull);
  EXPECT_THROW(
      {
        pushed.BringUp();
        pushed.Enable();
        pushed.Run(Text(kSteps));
      },
      std::runtime_error);
  EXPECT_EQ(pushed.record().reason, Reason::kFollowingError);
}

}  // namespace
}  // namespace contour::test
