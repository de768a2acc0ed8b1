// An incremental encoder: the axis knows where it is once it has been told, until its drive restarts.
#include <gtest/gtest.h>

#include "core/reference.h"
#include "daemon/path_feeder.h"
#include "daemon/program/path_generator.h"
#include "daemon/program_limits.h"
#include "daemon/reason_text.h"
#include "tests/closed_loop/test_machine.h"
#include "tests/closed_loop/tuned_loops.h"
#include "tests/support/drive_faults.h"

namespace contour::test {
namespace {

constexpr double kTold_mm = 80.0;

EmulatedMachineFile Incremental(const std::string& travel_mm) {
  std::vector<std::string> set;
  for (const char* axis : {"x", "y"}) {
    set.push_back(std::string("axes.") + axis + ".drive.absolute_encoder=false");
    set.push_back(std::string("emulator.axes.") + axis + ".incremental_encoder=true");
    set.push_back(std::string("axes.") + axis + ".limits.unreferenced_travel_mm=" + travel_mm);
  }
  return ExampleMachine(set);
}

class LostReference : public ::testing::Test {
 protected:
  explicit LostReference(const std::string& travel_mm = "5") { UseMachine(Incremental(travel_mm)); }
  void UseMachine(const EmulatedMachineFile& file) {
    machine_ = std::make_unique<VirtualMachine>(file, ControllerName::kFull);
    machine_->BringUp();
    began_mm_.clear();
    for (std::size_t i = 0; i < 2; ++i) began_mm_.push_back(1e3 * Table_m(i));
  }

  void Ticks(int n) {
    for (int i = 0; i < n; ++i) machine_->Tick();
  }
  [[nodiscard]] MachineState state() { return machine_->record().state; }
  [[nodiscard]] ReferenceState reference(std::size_t axis) {
    return machine_->record().axes[axis].reference_state;
  }
  [[nodiscard]] double position_mm(std::size_t axis) {
    return 1e3 * machine_->record().axes[axis].position_m;
  }
  /// How far it has really gone.
  [[nodiscard]] double true_mm(std::size_t axis) { return 1e3 * Table_m(axis) - began_mm_[axis]; }
  [[nodiscard]] double Table_m(std::size_t axis) {
    return machine_->emulated().truth().axes[axis].table_position_m;
  }

  bool Ask(RequestKind kind, std::uint32_t with = 0) {
    const std::uint32_t sequence = machine_->mailbox().Post(kind, with);
    for (int i = 0; i < 1000 && machine_->record().acknowledged != sequence; ++i) machine_->Tick();
    return machine_->record().acknowledged == sequence && machine_->record().acknowledged_ok;
  }
  bool Tell(std::size_t axis, double at_mm) {
    return Ask(RequestKind::kReference, Encode({static_cast<std::uint8_t>(axis), 1e-3 * at_mm}).value());
  }
  void TellBoth() {
    ASSERT_TRUE(Tell(0, kTold_mm));
    ASSERT_TRUE(Tell(1, -kTold_mm));
  }
  /// As far as the cycle lets it.
  void Move(double dx_mm) {
    machine_->Run(
        ParseProgram("{shape: line, dx_mm: " + std::to_string(dx_mm) + ", dy_mm: 0, feed_mm_min: 6000}",
                     "line of the test", ProgramFormat::kYaml));
  }
  void BeginMove(double dx_mm) {
    machine_->Start(
        ParseProgram("{shape: line, dx_mm: " + std::to_string(dx_mm) + ", dy_mm: 0, feed_mm_min: 6000}",
                     "line of the test", ProgramFormat::kYaml));
    Ticks(600);
    ASSERT_EQ(state(), MachineState::kRunning);
  }
  void Reset() {
    Ticks(300);
    machine_->mailbox().Post(RequestKind::kReset);
    for (int i = 0; i < 4000 && state() != MachineState::kIdle; ++i) machine_->Tick();
    ASSERT_EQ(state(), MachineState::kIdle) << Name(machine_->record().reason);
    Ticks(400);
  }
  /// Whether a program of this axis is refused for want of a reference.
  void ExpectProgramsRefused(std::uint8_t axis) {
    machine_->Enable();
    EXPECT_FALSE(Ask(RequestKind::kRun, 99));
    EXPECT_EQ(state(), MachineState::kReady);
    EXPECT_EQ(machine_->record().reason, Reason::kNotReferenced);
    EXPECT_EQ(machine_->record().reason_axis, axis);
    ASSERT_TRUE(Ask(RequestKind::kDisable));
    for (int i = 0; i < 1000 && state() != MachineState::kIdle; ++i) machine_->Tick();
    Ticks(400);
  }

  std::unique_ptr<VirtualMachine> machine_;
  PerAxis<double> began_mm_;
};

// A hundred turns of 5 mm, further than it can go, while its drive was off.
TEST_F(LostReference, AnAbsoluteEncoderThatComesBackElsewhereIsNotBelieved) {
  UseMachine(ExampleMachine());
  EXPECT_EQ(reference(0), ReferenceState::kAbsolute);
  const double stands_mm = position_mm(0);
  DriveFaults::Restart(machine_->emulated(), 0);
  DriveFaults::Displace(machine_->emulated(), 0, 100 * 1048576);
  Reset();
  EXPECT_NEAR(position_mm(0), stands_mm + 500.0, 0.01);
  EXPECT_EQ(reference(0), ReferenceState::kLost);
  EXPECT_EQ(reference(1), ReferenceState::kAbsolute);
  ExpectProgramsRefused(0);
  EXPECT_FALSE(Tell(1, 0.0)) << "that one knows";
  ASSERT_TRUE(Tell(0, stands_mm + 3.0));
  EXPECT_EQ(reference(0), ReferenceState::kTold);
  ASSERT_TRUE(Tell(0, stands_mm)) << "what was told wrong can be put right";
  EXPECT_EQ(reference(0), ReferenceState::kTold);
  machine_->Enable();
  Move(10.0);
  EXPECT_NEAR(position_mm(0), stands_mm + 10.0, 0.01);
  EXPECT_NEAR(true_mm(0), 10.0, 0.01);
}

TEST_F(LostReference, AnAbsoluteEncoderThatComesBackWhereItWasIsBelieved) {
  UseMachine(ExampleMachine());
  machine_->Enable();
  BeginMove(60.0);
  DriveFaults::Restart(machine_->emulated(), 0);  // it coasts, and is found where that took it
  Reset();
  EXPECT_EQ(reference(0), ReferenceState::kAbsolute);
  machine_->Enable();
  Move(-10.0);
}

// To the machine's own stop, which is beyond the limits.
TEST_F(LostReference, AnAbsoluteEncoderIsBelievedWhereItsAxisMayHaveFallen) {
  EmulatedMachineFile file = ExampleMachine();
  UseMachine(file);
  DriveFaults::Restart(machine_->emulated(), 0);
  DriveFaults::Displace(machine_->emulated(), 0, 100 * 1048576);
  Reset();
  EXPECT_EQ(reference(0), ReferenceState::kLost);
  const double friction_Nm = file.machine.axes.at("x").model.friction.Fc_minus_N *
                             ToSi(file.machine.axes.at("x").model.mechanics).radius_m_rad;
  file.machine.axes.at("x").model.extensions.constant_torque = ConstantTorqueExtension{-1.1 * friction_Nm};
  UseMachine(file);
  DriveFaults::Restart(machine_->emulated(), 0);
  DriveFaults::Displace(machine_->emulated(), 0, 100 * 1048576);
  Reset();
  EXPECT_EQ(reference(0), ReferenceState::kAbsolute);
  UseMachine(file);
  DriveFaults::Restart(machine_->emulated(), 0);
  DriveFaults::Displace(machine_->emulated(), 0, 200 * 1048576);
  Reset();
  EXPECT_EQ(reference(0), ReferenceState::kLost);
}

TEST_F(LostReference, AnAxisStandsWhereItWasToldAndGoesOnFromThere) {
  EXPECT_EQ(reference(0), ReferenceState::kNeverTold);
  TellBoth();
  EXPECT_EQ(reference(0), ReferenceState::kTold);
  EXPECT_NEAR(position_mm(0), kTold_mm, 1e-3);
  EXPECT_NEAR(position_mm(1), -kTold_mm, 1e-3);
  machine_->Enable();
  Move(30.0);
  EXPECT_NEAR(position_mm(0), kTold_mm + 30.0, 0.01);
  EXPECT_NEAR(true_mm(0), 30.0, 0.01);
  EXPECT_NEAR(position_mm(1), -kTold_mm, 1e-3);
}

TEST_F(LostReference, ADriveThatRestartsInMotionHasLostItAndProgramsAreRefused) {
  TellBoth();
  machine_->Enable();
  BeginMove(100.0);
  DriveFaults::Restart(machine_->emulated(), 0);
  Ticks(200);
  ASSERT_EQ(state(), MachineState::kFaulted);
  EXPECT_EQ(reference(0), ReferenceState::kLost);
  EXPECT_EQ(reference(1), ReferenceState::kTold);
  Reset();
  // What the position says is far from where the axis is, which is why nothing may run.
  EXPECT_GT(std::abs(position_mm(0) - kTold_mm - true_mm(0)), 40.0);
  EXPECT_NEAR(position_mm(1), -kTold_mm, 0.01) << "the other kept its count over the bring-up";
  ExpectProgramsRefused(0);

  ASSERT_TRUE(Tell(0, kTold_mm + true_mm(0)));
  EXPECT_EQ(reference(0), ReferenceState::kTold);
  machine_->Enable();
  const double before_mm = true_mm(0);
  Move(10.0);
  EXPECT_NEAR(true_mm(0), before_mm + 10.0, 0.02);
  EXPECT_NEAR(position_mm(0), kTold_mm + true_mm(0), 0.02);
}

/// What the same restart did before anybody asked for a reference, and still does where the file is wrong.
TEST_F(LostReference, AnEncoderThatIsCalledAbsoluteAndIsNotComesBackReadyAndWrong) {
  EmulatedMachineFile file = Incremental("0");
  for (auto& [name, axis] : file.machine.axes) axis.drive.absolute_encoder = true;
  UseMachine(file);
  machine_->Enable();
  BeginMove(100.0);
  DriveFaults::Restart(machine_->emulated(), 0);
  Ticks(200);
  Reset();
  machine_->Enable();
  EXPECT_EQ(state(), MachineState::kReady);
  const double wrong_mm = std::abs(position_mm(0) - true_mm(0));
  RecordProperty("wrong_mm", std::to_string(wrong_mm));
  EXPECT_GT(wrong_mm, 40.0);
}

/// A reading that stands under a torque which was not reported yet may be a frozen encoder as well as a motor
/// without torque: what is named torque_without_motion costs the reference, too.
TEST_F(LostReference, AReadingThatStandsUnderATorqueThatWasNeverReportedCostsIt) {
  TellBoth();
  machine_->Enable();
  DriveFaults::Freeze(machine_->emulated(), 0);
  machine_->Start(ParseProgram("{shape: line, dx_mm: 100, dy_mm: 0, feed_mm_min: 6000}", "line of the test",
                               ProgramFormat::kYaml));
  Ticks(600);
  ASSERT_EQ(state(), MachineState::kFaulted);
  ASSERT_EQ(machine_->record().reason, Reason::kTorqueWithoutMotion);
  EXPECT_EQ(reference(0), ReferenceState::kLost);
  EXPECT_EQ(reference(1), ReferenceState::kTold);
}

/// Before it was called a swing it was feedback_reversed or velocity_limit, which cost the reference.
TEST_F(LostReference, ASwingThatTakesTheVoltageAwayCostsIt) {
  std::vector<std::string> set = TunedExample("cst");
  for (const std::string axis : {"x", "y"}) {
    set.push_back("axes." + axis + ".drive.absolute_encoder=false");
    set.push_back("emulator.axes." + axis + ".incremental_encoder=true");
  }
  set.push_back("emulator.axes.x.effects.payload_step={time_s: 4, inertia_change_rel: 0.5}");
  set.push_back("emulator.seed=1");
  UseMachine(ExampleMachine(set));
  TellBoth();
  machine_->Enable();
  machine_->Start(ParseProgram("{shape: circle, radius_mm: 10, feed_mm_min: 3000, turns: 6}",
                               "circle of the test", ProgramFormat::kYaml));
  for (int i = 0; i < 9000 && state() != MachineState::kFaulted; ++i) machine_->Tick();
  ASSERT_EQ(state(), MachineState::kFaulted) << Name(machine_->record().reason);
  ASSERT_EQ(machine_->record().reason, Reason::kOscillation);
  ASSERT_EQ(machine_->record().axes[0].goal, DriveGoal::kDisabled);
  const std::string text =
      ReasonText(machine_->record(), machine_->axis_names(), std::array<std::string, 1>{"main"});
  EXPECT_TRUE(text.starts_with("axis x: the loop oscillates; voltage off. Check model")) << text;
  EXPECT_EQ(reference(0), ReferenceState::kLost);
  EXPECT_EQ(reference(1), ReferenceState::kTold);
}

TEST_F(LostReference, AnAxisThatOnlyRanFromWhereItStoodLosesThat) {
  machine_->Enable();
  Move(2.0);
  DriveFaults::Restart(machine_->emulated(), 1);
  Ticks(100);
  Reset();
  EXPECT_EQ(reference(0), ReferenceState::kNeverTold);
  EXPECT_EQ(reference(1), ReferenceState::kLost);
  ExpectProgramsRefused(1);
}

TEST_F(LostReference, ARestartBeforeAnythingMovedLosesNothing) {
  DriveFaults::Restart(machine_->emulated(), 0);
  Ticks(100);
  Reset();
  EXPECT_EQ(reference(0), ReferenceState::kNeverTold);
  machine_->Enable();
  Move(2.0);
}

TEST_F(LostReference, OurOwnResetCommunicationKeepsTheCount) {
  TellBoth();
  machine_->Enable();
  BeginMove(100.0);
  // Axis y restarts; x is brought up again beside it.
  DriveFaults::Restart(machine_->emulated(), 1);
  Ticks(200);
  Reset();
  EXPECT_EQ(reference(0), ReferenceState::kTold);
  EXPECT_NEAR(position_mm(0), kTold_mm + true_mm(0), 0.02);
  EXPECT_EQ(reference(1), ReferenceState::kLost);
}

TEST_F(LostReference, ALinkThatWasDownMayHaveHiddenARestart) {
  TellBoth();
  machine_->bus(0).SetLink(machine_->last().input.grid_time_ns, false);
  Ticks(20);
  machine_->bus(0).SetLink(machine_->last().input.grid_time_ns, true);
  Reset();
  EXPECT_EQ(reference(0), ReferenceState::kLost);
  EXPECT_EQ(reference(1), ReferenceState::kLost);
}

TEST_F(LostReference, ToldOnlyWhereItCanBeAndWhileNothingHoldsIt) {
  EXPECT_FALSE(Tell(0, 202.5)) << "beyond limits.position_mm by more than safe_travel_mm";
  EXPECT_FALSE(Tell(5, 0.0)) << "no such axis";
  machine_->Enable();
  EXPECT_FALSE(Tell(0, 10.0)) << "held";
  EXPECT_EQ(reference(0), ReferenceState::kNeverTold);
}

TEST_F(LostReference, BeforeItIsToldProgramsKeepWithinTheTravelThatIsStated) {
  machine_->Enable();
  EXPECT_NEAR(1e3 * machine_->record().axes[0].travel_max_m, 5.0, 0.01);
  Move(4.0);
  Move(-8.0);
  // Around where it was enabled, not around where it is.
  EXPECT_THROW(Move(-2.0), std::exception);
  EXPECT_THROW(Move(10.0), std::exception);
  Move(8.5);
}

/// Points that leave the travel, past the planner.
TEST_F(LostReference, TheGuardKeepsItWithinTheTravelToo) {
  machine_->Enable();
  PerAxis<double> start_m;
  PerAxis<PlanLimits> limits;
  for (std::size_t i = 0; i < 2; ++i) {
    start_m.push_back(machine_->record().axes[i].reference.position_m);
    limits.push_back({machine_->axis_names()[i], -0.2, 0.2, 0.25, 5.0, 200.0});
  }
  PathGenerator generator(ParseProgram("{shape: line, dx_mm: 30, dy_mm: 0, feed_mm_min: 6000}",
                                       "line of the test", ProgramFormat::kYaml),
                          start_m, limits, 1e-3, 77);
  machine_->mailbox().Post(RequestKind::kRun, 77);
  PathPoint point;
  bool held = generator.Next(point);
  for (int i = 0; i < 3000 && state() != MachineState::kFaulted; ++i) {
    while (held && machine_->mailbox().PushPathPoint(point)) held = generator.Next(point);
    machine_->Tick();
  }
  EXPECT_EQ(state(), MachineState::kFaulted);
  EXPECT_EQ(machine_->record().reason, Reason::kPositionLimit);
  Ticks(300);
  EXPECT_LT(true_mm(0), 7.0);
}

class NoTravelStated : public LostReference {
 protected:
  NoTravelStated() : LostReference("0") {}
};

TEST_F(NoTravelStated, NothingRunsBeforeTheAxesAreTold) {
  ExpectProgramsRefused(0);
  TellBoth();
  machine_->Enable();
  Move(2.0);
}

}  // namespace
}  // namespace contour::test
