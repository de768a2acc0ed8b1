#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "drivers/cia301/messages.h"
#include "tests/closed_loop/test_machine.h"
#include "tests/support/drive_faults.h"

namespace contour::test {
namespace {

/// I/O that a test switches.
class TestIo final : public IoSource {
 public:
  IoInput Read(std::int64_t) noexcept override { return input; }
  IoInput input{true, true, true, true, 20.0};
};

/// A machine that runs a circle at 3 m/min when something happens.
class Stops : public ::testing::Test {
 protected:
  Stops() : file_(ExampleMachine()), machine_(file_, ControllerName::kFull) {
    machine_.SetIo(io_);
    machine_.BringUp();
    machine_.Enable();
    StartCircle();
  }

  void StartCircle() {
    PerAxis<double> start_m;
    for (const AxisRecord& a : machine_.record().axes) start_m.push_back(a.reference.position_m);
    PerAxis<PlanLimits> limits;
    for (const char* name : {"x", "y"}) limits.push_back({name, -0.2, 0.2, 0.25, 5.0, 200.0});
    PathGenerator generator(Circle(10.0, 5, 0.7957747155), start_m, limits, 1e-3, ++program_);
    PathFeeder feeder(machine_.mailbox());
    machine_.mailbox().Post(RequestKind::kRun, program_);
    PathPoint point;
    bool held = generator.Next(point);
    int running = 0;
    for (int i = 0; i < 2000 && running < 300; ++i) {
      while (held && machine_.mailbox().PushPathPoint(point)) held = generator.Next(point);
      machine_.Tick();
      if (machine_.record().state == MachineState::kRunning) ++running;
    }
    generator_ = std::make_unique<PathGenerator>(std::move(generator));
    point_ = point;
    held_ = held;
    ASSERT_EQ(machine_.record().state, MachineState::kRunning);
    ASSERT_GT(Speed(), 0.04);
  }

  /// Ticks on, with the path supplied unless `dry`, until the emulated axes stand and no drive gives torque;
  /// the cycles.
  int TicksToStandstill(int limit, bool dry = false) {
    for (int i = 0; i < limit; ++i) {
      while (!dry && held_ && machine_.mailbox().PushPathPoint(point_)) held_ = generator_->Next(point_);
      machine_.Tick();
      if (i == 0) first_state_ = machine_.record().state;
      bool torque_off = true;
      for (const AxisTruth& a : machine_.emulated().truth().axes)
        torque_off = torque_off && a.drive_state != DriveState::kOperationEnabled &&
                     a.drive_state != DriveState::kQuickStopActive && std::abs(a.torque_Nm) < 1e-6;
      if (Speed() < 1e-4 && torque_off) return i + 1;
    }
    return limit + 1;
  }

  [[nodiscard]] double Speed() {
    const auto& axes = machine_.emulated().truth().axes;
    return std::hypot(axes[0].table_velocity_m_s, axes[1].table_velocity_m_s);
  }

  /// reset, enable, run: the machine works again in the same process.
  void ExpectWorksAgain() {
    for (int i = 0; i < 300; ++i) machine_.Tick();
    machine_.mailbox().Post(RequestKind::kReset);
    for (int i = 0; i < 3000 && machine_.record().state != MachineState::kIdle; ++i) machine_.Tick();
    ASSERT_EQ(machine_.record().state, MachineState::kIdle);
    for (int i = 0; i < 400; ++i) {
      machine_.Tick();
      for (const AxisTruth& a : machine_.emulated().truth().axes)
        ASSERT_NE(a.drive_state, DriveState::kOperationEnabled) << "nothing enables itself";
    }
    machine_.Enable();
    StartCircle();
  }

  EmulatedMachineFile file_;
  TestIo io_;
  VirtualMachine machine_;
  std::unique_ptr<PathGenerator> generator_;
  PathPoint point_;
  bool held_ = false;
  std::uint32_t program_ = 0;
  MachineState first_state_ = MachineState::kOff;
};

TEST_F(Stops, OperatorStopEndsOnThePathAndHolds) {
  machine_.mailbox().PostStop();
  for (int i = 0; i < 200; ++i) machine_.Tick();
  EXPECT_EQ(machine_.record().state, MachineState::kReady);
  EXPECT_EQ(machine_.record().reason, Reason::kOperatorStop);
  EXPECT_LT(Speed(), 1e-4);
  EXPECT_LT(std::abs(machine_.record().contour_error_m), 5e-6);
  StartCircle();
}

TEST_F(Stops, TerminateStopsOnThePathAndSwitchesOff) {
  machine_.mailbox().PostTerminate();
  EXPECT_LE(TicksToStandstill(300), 150);
  EXPECT_EQ(machine_.record().reason, Reason::kTerminate);
  EXPECT_TRUE(machine_.last().output.finished);
}

TEST_F(Stops, EmergencyStopInput) {
  io_.input.emergency_stop_ok = false;
  EXPECT_LE(TicksToStandstill(300), 60);
  EXPECT_EQ(first_state_, MachineState::kFaulted);
  EXPECT_EQ(machine_.record().reason, Reason::kEmergencyStop);
  io_.input.emergency_stop_ok = true;
  ExpectWorksAgain();
}

TEST_F(Stops, EnableChainAndLostIoStopOnThePath) {
  io_.input.fresh = false;
  EXPECT_LE(TicksToStandstill(300), 150);
  EXPECT_EQ(machine_.record().state, MachineState::kFaulted);
  EXPECT_EQ(machine_.record().reason, Reason::kIoStale);
  io_.input.fresh = true;
  ExpectWorksAgain();
}

TEST_F(Stops, BusDown) {
  machine_.bus(0).SetLink(machine_.last().input.grid_time_ns, false);
  // The emulated machine counts SYNCs; it takes 200 ms of silence to go on by itself, then its drives notice.
  EXPECT_LE(TicksToStandstill(400), 300) << "the drives notice the silence and stop by themselves";
  EXPECT_EQ(machine_.record().state, MachineState::kFaulted);
  EXPECT_EQ(machine_.record().reason, Reason::kBusDown);
  machine_.bus(0).SetLink(machine_.last().input.grid_time_ns, true);
  ExpectWorksAgain();
}

/// As SocketCAN tells of its controller: the error class, and its state.
void Says(LoopbackBus& bus, std::uint32_t id, std::uint8_t controller = 0) {
  const std::array<std::uint8_t, 8> data{0, controller};
  bus.InjectErrorFrame(id | CAN_ERR_FLAG, data);
}

TEST_F(Stops, BusOffStopsAndErrorPassiveDoesNot) {
  Says(machine_.bus(0), CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  for (int i = 0; i < 50; ++i) TicksToStandstill(1);
  EXPECT_EQ(machine_.record().state, MachineState::kRunning);
  Says(machine_.bus(0), CAN_ERR_BUSOFF);
  EXPECT_LE(TicksToStandstill(400), 300);
  EXPECT_EQ(machine_.record().state, MachineState::kFaulted);
  EXPECT_EQ(machine_.record().reason, Reason::kBusOff);
  Says(machine_.bus(0), CAN_ERR_RESTARTED);
  ExpectWorksAgain();
}

TEST_F(Stops, DriveFault) {
  DriveFaults::Inject(machine_.emulated(), 1, 0x3210);
  EXPECT_LE(TicksToStandstill(300), 80);
  EXPECT_EQ(machine_.record().state, MachineState::kFaulted);
  EXPECT_EQ(machine_.record().reason, Reason::kDriveFault);
  EXPECT_EQ(machine_.record().reason_axis, 1);
  EXPECT_EQ(machine_.record().axes[1].emergency_code, 0x3210);
  ExpectWorksAgain();
}

/// Another master on the bus of a moving machine.
class SecondMaster : public Stops, public ::testing::WithParamInterface<CanFrame> {
 protected:
  void OtherSends() { machine_.bus(0).Inject(machine_.last().input.grid_time_ns, GetParam()); }
  std::size_t FramesSent(int cycles) {
    std::size_t frames = 0;
    for (int i = 0; i < cycles; ++i) {
      machine_.Tick();
      frames += machine_.last().output.frames.size();
    }
    return frames;
  }
  void Reset(int limit) {
    machine_.mailbox().Post(RequestKind::kReset);
    machine_.Tick();
    for (int i = 0; i < limit && machine_.record().state == MachineState::kStarting; ++i) {
      machine_.Tick();
      if (other_is_there_ && i % 10 == 0) OtherSends();
    }
  }
  bool other_is_there_ = true;
};

TEST_P(SecondMaster, DrivesAreBroughtToRestThenTheBusIsLeftAlone) {
  OtherSends();
  machine_.Tick();
  // Without SYNC the emulated machine waits 200 ms before it goes on by itself: so late it is seen to rest.
  EXPECT_LE(TicksToStandstill(400), 80 + 200);
  EXPECT_EQ(first_state_, MachineState::kFaulted);
  EXPECT_EQ(machine_.record().reason, Reason::kSecondMaster);
  EXPECT_EQ(machine_.record().reason_axis, 0) << "the bus";
  EXPECT_EQ(machine_.record().bring_up.found, GetParam().id);
  EXPECT_EQ(FramesSent(500), 0u);

  Reset(3000);
  EXPECT_EQ(machine_.record().state, MachineState::kFaulted);
  EXPECT_EQ(machine_.record().reason, Reason::kSecondMaster) << "it is still there";
  EXPECT_EQ(FramesSent(500), 0u);
  other_is_there_ = false;
  ExpectWorksAgain();
}

INSTANTIATE_TEST_SUITE_P(Signs, SecondMaster,
                         ::testing::Values(SyncFrame(), HeartbeatFrame(127, NmtState::kOperational),
                                           CanFrame{0x202, 4, {0x0F, 0, 0, 0}},
                                           NmtFrame(NmtCommand::kStart, 0)));

// Its drive gave no torque any more; the loop would brake it as hard as it can.
TEST(StopsOfOneAxis, AnAxisThatCoastsIsNotEnabledBeforeItStands) {
  std::vector<std::string> set{"axes.x.drive.mode=cst", "axes.y.drive.mode=cst"};
  for (const char* friction : {"axes.x.model.friction.", "emulator.axes.x.friction."})
    for (const char* little :
         {"Fs_plus_N=22", "Fs_minus_N=22", "Fc_plus_N=20", "Fc_minus_N=20", "sigma2_Ns_m=50"})
      set.push_back(std::string(friction) + little);
  Surroundings promptly;
  promptly.prompt = true;
  VirtualMachine machine(ExampleMachine(set), ControllerName::kFull, EmulatedClock::kWall, promptly);
  machine.BringUp();
  machine.Enable();
  machine.Start(ParseProgram("{shape: line, dx_mm: 150, dy_mm: 0, feed_mm_min: 14000}", "line of the test",
                             ProgramFormat::kYaml));
  const auto speed_m_s = [&] { return machine.emulated().truth().axes[0].motor_velocity_m_s; };
  for (int i = 0; i < 3000 && speed_m_s() < 0.23; ++i) machine.Tick();
  ASSERT_GT(speed_m_s(), 0.23);
  DriveFaults::Report(machine.emulated(), 0, 0x7305, 0x20);
  for (int i = 0; i < 10 && machine.record().state != MachineState::kFaulted; ++i) machine.Tick();
  machine.mailbox().Post(RequestKind::kReset);
  for (int i = 0; i < 500 && machine.record().state != MachineState::kIdle; ++i) machine.Tick();
  ASSERT_EQ(machine.record().state, MachineState::kIdle);
  ASSERT_GT(speed_m_s(), 0.07) << "it still coasts";

  const auto enable = [&] {
    const std::uint32_t sequence = machine.mailbox().Post(RequestKind::kEnable);
    for (int i = 0; i < 10 && machine.record().acknowledged != sequence; ++i) machine.Tick();
    return machine.record().acknowledged_ok;
  };
  EXPECT_FALSE(enable());
  EXPECT_EQ(machine.record().reason, Reason::kAxisMoves);
  EXPECT_EQ(machine.record().reason_axis, 0);
  EXPECT_EQ(machine.record().state, MachineState::kIdle);
  bool taken = false;
  for (int i = 0; i < 3000 && !taken; ++i) taken = enable();
  ASSERT_TRUE(taken);
  // By a standing axis's loop, within the limit of acceleration: 5 m/s^2.
  double most_m_s2 = 0.0, before_m_s = speed_m_s();
  for (int i = 0; i < 500; ++i) {
    machine.Tick();
    if (machine.record().state == MachineState::kReady)
      most_m_s2 = std::max(most_m_s2, std::abs(speed_m_s() - before_m_s) / 1e-3);
    before_m_s = speed_m_s();
  }
  EXPECT_EQ(machine.record().state, MachineState::kReady);
  EXPECT_LT(most_m_s2, 5.0);
  RecordProperty("speed_at_enabling_mm_s", std::to_string(1e3 * before_m_s));
}

TEST_F(Stops, PathSupplyRunsDry) {
  EXPECT_LE(TicksToStandstill(3000, true), 2500);
  EXPECT_EQ(machine_.record().state, MachineState::kFaulted);
  EXPECT_EQ(machine_.record().reason, Reason::kPathUnderrun);
}

}  // namespace
}  // namespace contour::test
