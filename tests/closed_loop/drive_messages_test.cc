// What drives say besides their positions, while the machine runs: emergency messages, boot-up, another
// state.
#include <gtest/gtest.h>

#include <span>

#include "daemon/make_cycle_config.h"
#include "daemon/reason_text.h"
#include "daemon/rt/cycle_runner.h"
#include "drivers/can/loopback_bus.h"
#include "drivers/cia301/messages.h"
#include "tests/closed_loop/test_machine.h"
#include "tests/drivers/cia402/fake_slave.h"
#include "tests/support/drive_faults.h"

namespace contour::test {
namespace {

class DriveMessages : public ::testing::Test {
 protected:
  void Begin(std::vector<std::string> overrides = {}) {
    file_ = ExampleMachine(std::move(overrides));
    machine_ = std::make_unique<VirtualMachine>(file_, ControllerName::kFull);
    machine_->BringUp();
    machine_->Enable();
  }
  void BeginInMotion(std::vector<std::string> overrides = {}) {
    Begin(std::move(overrides));
    machine_->Start(Circle(10.0, 5, 0.7957747155));
    for (int i = 0; i < 3000 && record().state != MachineState::kRunning; ++i) machine_->Tick();
    Ticks(300);
    ASSERT_EQ(record().state, MachineState::kRunning);
  }
  void Ticks(int n) {
    for (int i = 0; i < n; ++i) machine_->Tick();
  }
  /// Cycles until the machine is in this state; `limit` and one when it does not come.
  int TicksUntil(MachineState state, int limit) {
    for (int i = 0; i < limit; ++i) {
      if (record().state == state) return i;
      machine_->Tick();
    }
    return record().state == state ? limit : limit + 1;
  }
  [[nodiscard]] const CycleRecord& record() const { return machine_->record(); }
  [[nodiscard]] std::string Text() const {
    return ReasonText(record(), machine_->axis_names(), std::array<std::string, 1>{"main"});
  }
  void Report(std::size_t axis, std::uint16_t code, std::uint8_t error_register = 0x01) {
    DriveFaults::Report(machine_->emulated(), axis, code, error_register);
  }
  /// As another program on the bus would.
  void Send(const CanFrame& frame) {
    machine_->bus(0).Send(machine_->last().input.grid_time_ns, std::span(&frame, 1));
  }
  [[nodiscard]] DriveState drive(std::size_t axis) {
    return machine_->emulated().truth().axes[axis].drive_state;
  }

  EmulatedMachineFile file_;
  std::unique_ptr<VirtualMachine> machine_;
};

TEST_F(DriveMessages, OverTemperatureInMotionStopsOnThePath) {
  BeginInMotion();
  Report(1, 0x4210, 0x09);
  EXPECT_LE(TicksUntil(MachineState::kStopping, 10), 4);
  double worst_m = 0.0;
  for (int i = 0; i < 400 && record().state == MachineState::kStopping; ++i) {
    machine_->Tick();
    if (record().state == MachineState::kStopping)
      worst_m = std::max(worst_m, std::abs(record().contour_error_m));
  }
  EXPECT_LT(worst_m, 5e-6);
  EXPECT_EQ(record().state, MachineState::kFaulted);
  EXPECT_EQ(record().reason, Reason::kDriveEmergency);
  EXPECT_EQ(record().reason_axis, 1);
  EXPECT_NE(Text().find("axis y: the drive sent emergency code 0x4210 (excess temperature of the device)"),
            std::string::npos)
      << Text();
}

TEST_F(DriveMessages, AFaultyEncoderTakesTheVoltageOfItsAxis) {
  BeginInMotion();
  Report(0, 0x7305);
  EXPECT_LE(TicksUntil(MachineState::kFaulted, 10), 4);
  EXPECT_EQ(record().reason, Reason::kDriveEmergency);
  EXPECT_EQ(record().axes[0].goal, DriveGoal::kDisabled);
  EXPECT_EQ(record().axes[1].goal, DriveGoal::kQuickStop);
  Ticks(2);
  EXPECT_EQ(drive(0), DriveState::kSwitchOnDisabled) << "no braking by an encoder that is faulty";
  EXPECT_EQ(drive(1), DriveState::kQuickStopActive);
}

TEST_F(DriveMessages, AWarningIsShownAndTheProgramGoesOn) {
  BeginInMotion();
  Report(0, 0x8120, 0x11);
  Ticks(100);
  EXPECT_EQ(record().state, MachineState::kRunning);
  EXPECT_EQ(record().axes[0].emergency_code, 0x8120);
  EXPECT_EQ(record().axes[0].limit, Reason::kEmergencyNoticed);
}

TEST_F(DriveMessages, AWarningIsTakenMoreSeriouslyWhereTheMachineFileSaysSo) {
  BeginInMotion({"axes.x.drive.emergency_reaction.0x812x=quick_stop"});
  Report(0, 0x8120, 0x11);
  EXPECT_LE(TicksUntil(MachineState::kFaulted, 10), 4);
  EXPECT_EQ(record().reason, Reason::kDriveEmergency);
}

TEST_F(DriveMessages, WhatStandsKeepsTheMachineFromBeingEnabledUntilAReset) {
  Begin();
  Report(0, 0x4210, 0x09);
  EXPECT_LE(TicksUntil(MachineState::kFaulted, 20), 10) << "at rest there is nothing to wait for";
  Ticks(200);
  machine_->mailbox().Post(RequestKind::kReset);
  EXPECT_LE(TicksUntil(MachineState::kIdle, 2000), 2000);
  machine_->Enable();
  EXPECT_EQ(record().state, MachineState::kReady);
}

TEST_F(DriveMessages, ADriveThatRestartedIsSaidToHaveRestarted) {
  BeginInMotion();
  Send(NmtFrame(NmtCommand::kResetNode, 2));
  EXPECT_LE(TicksUntil(MachineState::kFaulted, 10), 10);
  Ticks(20);
  EXPECT_TRUE(record().reason == Reason::kDriveRestarted || record().reason == Reason::kDriveLeftEnabled)
      << Name(record().reason);
  EXPECT_EQ(record().reason_axis, 1);
}

TEST_F(DriveMessages, ADriveThatRestartsAtRestIsSaidToHaveRestarted) {
  file_ = ExampleMachine();
  machine_ = std::make_unique<VirtualMachine>(file_, ControllerName::kFull);
  machine_->BringUp();
  Send(NmtFrame(NmtCommand::kResetNode, 2));
  EXPECT_LE(TicksUntil(MachineState::kFaulted, 300), 300);
  EXPECT_EQ(record().reason, Reason::kDriveRestarted);
  EXPECT_EQ(record().reason_axis, 1);
}

TEST_F(DriveMessages, ADriveThatLeftOperationalIsSaidToHaveLeftIt) {
  file_ = ExampleMachine();
  machine_ = std::make_unique<VirtualMachine>(file_, ControllerName::kFull);
  machine_->BringUp();
  Send(NmtFrame(NmtCommand::kEnterPreOperational, 1));
  EXPECT_LE(TicksUntil(MachineState::kFaulted, 300), 300);
  EXPECT_EQ(record().reason, Reason::kDriveLeftOperational);
  EXPECT_EQ(record().reason_axis, 0);
}

TEST_F(DriveMessages, TheReasonTellsWhatWasSoWhenItArose) {
  BeginInMotion();
  DriveFaults::Inject(machine_->emulated(), 1, 0x3210);
  EXPECT_LE(TicksUntil(MachineState::kFaulted, 10), 10);
  EXPECT_EQ(record().reason, Reason::kDriveFault);
  Ticks(5);
  const std::string soon = Text();
  EXPECT_NE(
      soon.find("axis y: the drive reports a fault, drive in state Fault Reaction Active, emergency code "
                "0x3210 (DC link over-voltage)"),
      std::string::npos)
      << soon;
  Ticks(500);
  EXPECT_EQ(drive(1), DriveState::kFault);
  EXPECT_EQ(Text(), soon) << "not how the drive stands after the stop";
}

/// The cycle with scripted drives in place of the emulated ones.
class ScriptedDrives : public ::testing::Test {
 protected:
  ScriptedDrives() : cycle_(Config()) {
    for (FakeSlave& s : slaves_) s.behaviour = {};
    runner_ = std::make_unique<CycleRunner>(cycle_, buses_, mailbox_, io_);
  }
  static CycleConfig Config() {
    CycleConfig config = MakeCycleConfig(ExampleMachine().machine, ControllerName::kFull);
    for (AxisDriveConfig& a : config.master.axes) a.drive.identity.reset();
    return config;
  }
  bool TicksUntil(MachineState state, int limit) {
    for (int i = 0; i < limit && record().state != state; ++i) {
      ++index_;
      runner_->Tick({index_, static_cast<std::int64_t>(index_) * 1'000'000, 0}, true, *entry_);
    }
    return record().state == state;
  }
  [[nodiscard]] const CycleRecord& record() const { return entry_->output.record; }
  [[nodiscard]] std::string Text() const {
    return ReasonText(record(), std::array<std::string, 2>{"x", "y"}, std::array<std::string, 1>{"main"});
  }

  std::array<FakeSlave, 2> slaves_{FakeSlave(1), FakeSlave(2)};
  LoopbackBus bus_{1'000'000, {&slaves_[0], &slaves_[1]}};
  std::vector<FrameBus*> buses_{&bus_};
  Cycle cycle_;
  CommandMailbox mailbox_{4, 16};
  NoIo io_;
  std::unique_ptr<CycleRunner> runner_;
  std::unique_ptr<CycleEntry> entry_ = std::make_unique<CycleEntry>();
  std::uint64_t index_ = 0;
};

TEST_F(ScriptedDrives, ADriveThatDoesNotEnableIsNamedWithTheStateItStayedIn) {
  slaves_[1].behaviour.stuck_in = DriveState::kSwitchedOn;
  ASSERT_TRUE(TicksUntil(MachineState::kIdle, 3000)) << Text();
  TicksUntil(MachineState::kFaulted, 20);
  mailbox_.Post(RequestKind::kEnable);
  ASSERT_TRUE(TicksUntil(MachineState::kFaulted, 3000));
  TicksUntil(MachineState::kIdle, 100);  // so much later
  EXPECT_EQ(record().reason, Reason::kEnableTimeout);
  EXPECT_EQ(record().reason_axis, 1);
  EXPECT_NE(
      Text().find("axis y: the drive did not reach Operation Enabled, it stayed in Switched On for 500 ms "
                  "(drive.transition_ms)"),
      std::string::npos)
      << Text();
}

TEST_F(ScriptedDrives, ADriveThatNeverSaysThatItFollowsIsTheErrorThatNamesTheKey) {
  slaves_[0].behaviour.follows = false;
  ASSERT_TRUE(TicksUntil(MachineState::kIdle, 3000)) << Text();
  TicksUntil(MachineState::kFaulted, 20);
  mailbox_.Post(RequestKind::kEnable);
  ASSERT_TRUE(TicksUntil(MachineState::kFaulted, 100));
  EXPECT_EQ(record().reason, Reason::kDriveNotFollowing);
  EXPECT_EQ(record().reason_axis, 0);
  EXPECT_EQ(record().axes[0].goal, DriveGoal::kQuickStop);
  EXPECT_NE(Text().find("bits 12 and 9 do not say so set drive.follows_target_bit: false; then neither"),
            std::string::npos)
      << Text();
}

}  // namespace
}  // namespace contour::test
