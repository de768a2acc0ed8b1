#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <string>

#include "drivers/can/loopback_bus.h"
#include "drivers/cia301/bring_up_text.h"
#include "drivers/cia402/drive_master.h"
#include "tests/plant_emulator/drive_harness.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/drive_faults.h"
#include "tools/plant_emulator/emulated_machine.h"

// The master and the emulated machine were written apart from each other, from the standards.
namespace contour::test {
namespace {

DriveConfig Drive(int node_id, DriveMode mode) {
  DriveConfig d;
  d.bus = "main";
  d.node_id = node_id;
  d.mode = mode;
  d.rated_torque_Nm = 0.637;
  d.peak_torque_Nm = 1.91;
  d.encoder_counts_per_rev = 1048576;
  d.identity = IdentityConfig{0x0C0D, 0x0402, 0x00010000};
  d.quick_stop_deceleration_rad_s2 = 5000;
  return d;
}

class Machine {
 public:
  explicit Machine(DriveMode mode = DriveMode::kCst, EmulatedClock clock = EmulatedClock::kSync)
      : emulated(NominalMachine(), std::array{Place("x", 1), Place("y", 2)}, 1000, clock),
        bus(1'000'000, {&emulated.node(0)}),
        master({{{"x", 0, Drive(1, mode), 1.5}, {"y", 0, Drive(2, mode), 1.5}},
                {BusConfig{"loopback", 1'000'000, 127, 0.0}},
                1000}),
        setpoints(2) {}

  void Cycle() {
    CycleInput in;
    in.cycle = ++cycle;
    std::array<StampedFrame, kMaxFramesPerCycle> received;
    const std::size_t n = bus.Receive(now_ns(), received);
    for (std::size_t i = 0; i < n; ++i) in.frames.push_back(received[i]);
    in.buses.push_back({bus.State().up, false, 0});
    master.Receive(in);
    DriveMaster::Frames sent;
    master.Send(setpoints, sent);
    for (const StampedFrame& f : sent) bus.Send(now_ns(), std::span(&f.frame, 1));
  }
  void Cycles(int n) {
    for (int i = 0; i < n; ++i) Cycle();
  }
  bool BringUp() {
    master.StartBringUp();
    for (int i = 0; i < 5000 && !master.operational() && !master.bring_up_failed(); ++i) Cycle();
    return master.operational();
  }
  bool Reach(DriveGoal goal, int limit = 400) {
    for (AxisSetpoint& s : setpoints) s.goal = goal;
    for (int i = 0; i < limit; ++i) {
      Cycle();
      if (master.status()[0].at_goal && master.status()[1].at_goal) return true;
    }
    return false;
  }
  [[nodiscard]] std::int64_t now_ns() const { return static_cast<std::int64_t>(cycle) * 1'000'000; }
  [[nodiscard]] std::string Text() const {
    return BringUpText(master.bring_up(), std::array<std::string, 2>{"x", "y"});
  }

  EmulatedMachine emulated;
  LoopbackBus bus;
  DriveMaster master;
  PerAxis<AxisSetpoint> setpoints;
  std::uint64_t cycle = 0;
};

TEST(EmulatedDrive, ComesUpEnablesAndFollowsTorque) {
  Machine m;
  ASSERT_TRUE(m.BringUp()) << m.Text();
  ASSERT_TRUE(m.Reach(DriveGoal::kSwitchedOn));
  ASSERT_TRUE(m.Reach(DriveGoal::kEnabled));
  const double before = m.master.feedback()[0].position_rad;
  m.setpoints[0].torque_Nm = 0.1;
  m.Cycles(100);
  EXPECT_GT(m.master.feedback()[0].position_rad, before + 0.1);
  EXPECT_TRUE(m.master.feedback()[0].fresh);
  EXPECT_NEAR(m.master.feedback()[0].torque_Nm, 0.1, 0.002);
  EXPECT_EQ(m.master.status()[0].emergency_code, 0);
  // What the master believes to be at SYNC n is what the machine was at SYNC n.
  const TruthRow& truth = m.emulated.truth();
  EXPECT_EQ(truth.sync_number, m.master.feedback_sync());
  EXPECT_NEAR(m.master.feedback()[0].position_rad, truth.axes[0].reported_position_rad, 1e-9);
}

TEST(EmulatedDrive, RunsInCspToo) {
  Machine m(DriveMode::kCsp);
  ASSERT_TRUE(m.BringUp()) << m.Text();
  m.Cycles(3);
  const double start = m.master.feedback()[0].position_rad;
  for (AxisSetpoint& s : m.setpoints) s.position_rad = m.master.feedback()[1].position_rad;
  m.setpoints[0].position_rad = start;
  ASSERT_TRUE(m.Reach(DriveGoal::kEnabled));
  for (int i = 0; i < 500; ++i) {
    m.setpoints[0].position_rad += 0.002;
    m.Cycle();
  }
  m.Cycles(200);
  EXPECT_NEAR(m.master.feedback()[0].position_rad, start + 1.0, 0.02);
}

TEST(EmulatedDrive, QuickStopEndsAtRestWithoutTorque) {
  Machine m;
  ASSERT_TRUE(m.BringUp()) << m.Text();
  ASSERT_TRUE(m.Reach(DriveGoal::kEnabled));
  m.setpoints[0].torque_Nm = 0.3;
  m.Cycles(100);
  EXPECT_GT(std::abs(m.emulated.truth().axes[0].table_velocity_m_s), 0.01);
  ASSERT_TRUE(m.Reach(DriveGoal::kQuickStop));
  m.Cycles(50);
  EXPECT_NEAR(m.emulated.truth().axes[0].table_velocity_m_s, 0.0, 1e-3);
  EXPECT_EQ(m.master.feedback()[0].drive_state, DriveState::kSwitchOnDisabled);
}

TEST(EmulatedDrive, AFaultIsReportedResetAndDrivenOn) {
  Machine m;
  ASSERT_TRUE(m.BringUp()) << m.Text();
  ASSERT_TRUE(m.Reach(DriveGoal::kEnabled));
  DriveFaults::Inject(m.emulated, 1, 0x3210);
  m.Cycles(5);
  EXPECT_TRUE(m.master.status()[1].fault);
  EXPECT_EQ(m.master.status()[1].emergency_code, 0x3210);
  EXPECT_FALSE(m.Reach(DriveGoal::kQuickStop, 100));
  ASSERT_TRUE(m.Reach(DriveGoal::kFaultReset));
  ASSERT_TRUE(m.Reach(DriveGoal::kEnabled));
  EXPECT_EQ(m.master.status()[1].emergency_code, 0);
}

// A link that is gone: the drives stop by themselves within notice_ms; `reset` afterwards brings them up
// again.
TEST(EmulatedDrive, StopsByItselfWhenTheBusIsGone) {
  Machine m(DriveMode::kCst, EmulatedClock::kWall);
  ASSERT_TRUE(m.BringUp()) << m.Text();
  ASSERT_TRUE(m.Reach(DriveGoal::kEnabled));
  m.setpoints[0].torque_Nm = 0.1;
  m.Cycles(100);
  const double before_m = m.emulated.truth().axes[0].table_position_m;
  m.bus.SetLink(m.now_ns(), false);
  m.Cycles(12);
  EXPECT_NE(m.emulated.truth().axes[0].drive_state, DriveState::kOperationEnabled);
  m.Cycles(300);
  EXPECT_NEAR(m.emulated.truth().axes[0].table_velocity_m_s, 0.0, 1e-3);
  EXPECT_LT(m.emulated.truth().axes[0].table_position_m - before_m, 2e-3);
  EXPECT_FALSE(m.master.operational());

  m.bus.SetLink(m.now_ns(), true);
  m.setpoints[0].torque_Nm = 0.0;
  for (AxisSetpoint& s : m.setpoints) s.goal = DriveGoal::kDisabled;
  ASSERT_TRUE(m.BringUp()) << m.Text();
  ASSERT_TRUE(m.Reach(DriveGoal::kFaultReset));
  ASSERT_TRUE(m.Reach(DriveGoal::kEnabled));
}

TEST(EmulatedDrive, TheWholeWayTouchesNoHeap) {
  if (!AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  Machine m;
  const AllocationGuard guard;
  const bool up = m.BringUp();
  const bool enabled = up && m.Reach(DriveGoal::kEnabled);
  m.Cycles(100);
  DriveFaults::Inject(m.emulated, 0, 0x3210);
  m.Cycles(20);
  m.Reach(DriveGoal::kQuickStop, 50);
  m.Reach(DriveGoal::kFaultReset);
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(enabled) << m.Text();
}

}  // namespace
}  // namespace contour::test
