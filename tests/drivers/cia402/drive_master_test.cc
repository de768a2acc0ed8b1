#include "drivers/cia402/drive_master.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "tests/drivers/cia402/two_drives.h"
#include "tests/support/allocation_guard.h"

namespace contour::test {
namespace {

TEST(DriveMaster, BringsUpTwoDrivesAndExchangesPdos) {
  Machine m;
  m.BringUp();
  ASSERT_TRUE(m.master.operational())
      << "error " << int{m.master.bring_up().error} << " index " << std::hex << m.master.bring_up().index;
  EXPECT_EQ(m.slave[0].nmt(), NmtState::kOperational);
  EXPECT_EQ(m.slave[1].nmt(), NmtState::kOperational);
  m.Cycles(3);
  EXPECT_TRUE(m.master.feedback()[0].fresh);
  EXPECT_TRUE(m.master.feedback()[1].fresh);
  EXPECT_NEAR(m.master.feedback()[0].position_rad, 1000 * kRadPerCount, 1e-12);
  EXPECT_EQ(m.master.feedback_sync() + 1, m.master.sync_number());  // latched at the SYNC before this cycle's
  EXPECT_EQ(m.slave[0].syncs(), m.master.feedback_sync());
}

// An encoder that was put on anew while its drive was off, or a zero that was moved, has the axis elsewhere.
TEST(DriveMaster, AnAbsoluteEncoderThatComesBackElsewhereIsNotBelieved) {
  constexpr double kUnseen_rad = 1.0;
  const std::int64_t turn = 1048576;
  MasterConfig config = TwoAxes();
  for (AxisDriveConfig& a : config.axes) {
    a.drive.absolute_encoder = true;
    a.unseen_travel_rad = kUnseen_rad;
  }
  Machine m(config);
  m.BringUp();
  m.Cycles(10);
  const auto restart = [&](std::int64_t moved_counts) {
    m.slave[0].Restart(m.now_ns());
    m.slave[0].set_position(m.slave[0].position() + moved_counts);
    m.Cycles(20);
    m.BringUp();
    m.Cycles(10);
    EXPECT_TRUE(m.master.operational());
  };
  restart(turn / 10);
  EXPECT_EQ(m.master.reference(0), ReferenceState::kAbsolute) << "moved by hand, no further than it may";
  EXPECT_FALSE(m.master.CanTellPosition(0));
  restart(5 * turn);
  EXPECT_EQ(m.master.reference(0), ReferenceState::kLost);
  EXPECT_EQ(m.master.reference(1), ReferenceState::kAbsolute);
  ASSERT_TRUE(m.master.CanTellPosition(0));
  m.master.TellPosition(0, 2.5);
  EXPECT_EQ(m.master.reference(0), ReferenceState::kTold);
  m.Cycles(3);
  EXPECT_NEAR(m.master.feedback()[0].position_rad, 2.5, 1e-9);
  ASSERT_TRUE(m.master.CanTellPosition(0)) << "what was told wrong can be put right";
  m.master.TellPosition(0, 1.5);
  restart(0);
  EXPECT_EQ(m.master.reference(0), ReferenceState::kTold);
  EXPECT_NEAR(m.master.feedback()[0].position_rad, 1.5, 1e-9) << "what it was told outlives a restart";
}

// It says anything until its drive has read it, and an axis that is moved back is where it was.
TEST(DriveMaster, AnAbsoluteEncoderIsBelievedAgainWhereItWasSeen) {
  const std::int64_t turn = 1048576;
  MasterConfig config = TwoAxes();
  for (AxisDriveConfig& a : config.axes) {
    a.drive.absolute_encoder = true;
    a.unseen_travel_rad = 1.0;
  }
  Machine m(config);
  m.BringUp();
  m.Cycles(10);
  const auto right = m.slave[0].position();
  for (int again = 0; again < 2; ++again) {
    m.slave[0].Restart(m.now_ns());
    m.slave[0].set_position(right + 5 * turn);
    m.Cycles(20);
    m.BringUp();
    m.Cycles(10);
    EXPECT_EQ(m.master.reference(0), ReferenceState::kLost) << again;
  }
  m.slave[0].set_position(right);
  m.Cycles(10);
  EXPECT_EQ(m.master.reference(0), ReferenceState::kAbsolute);
}

// Seen last in motion it may have coasted.
TEST(DriveMaster, AnAbsoluteEncoderMayHaveCoastedFromWhereItWasSeen) {
  const std::int64_t turn = 1048576;
  for (const double coast_s2_rad : {0.0, 1.0}) {
    MasterConfig config = TwoAxes();
    for (AxisDriveConfig& a : config.axes) {
      a.drive.absolute_encoder = true;
      a.unseen_travel_rad = 1.0;
      a.coast_s2_rad = coast_s2_rad;
    }
    Machine m(config);
    m.BringUp();
    for (int i = 0; i < 10; ++i) {  // 5 rad/s: 25 rad by coasting
      m.slave[0].set_position(m.slave[0].position() + turn / 1257);
      m.Cycle();
    }
    m.slave[0].Restart(m.now_ns());
    m.slave[0].set_position(m.slave[0].position() + 3 * turn);
    m.Cycles(20);
    m.BringUp();
    m.Cycles(10);
    EXPECT_EQ(m.master.reference(0), coast_s2_rad > 0.0 ? ReferenceState::kAbsolute : ReferenceState::kLost);
  }
}

TEST(DriveMaster, WalksToEnabledAndSendsTorque) {
  Machine m;
  m.BringUp();
  m.Reach(DriveGoal::kSwitchedOn);
  EXPECT_EQ(m.slave[0].state(), DriveState::kSwitchedOn);
  m.setpoints[0].torque_Nm = 0.1;
  m.setpoints[1].torque_Nm = -0.2;
  m.Cycle();
  EXPECT_EQ(m.master.sent_torque_Nm()[0], 0.0) << "no torque before the drive is enabled";
  m.Reach(DriveGoal::kEnabled);
  EXPECT_EQ(m.slave[0].state(), DriveState::kOperationEnabled);
  m.Cycles(3);
  EXPECT_EQ(m.slave[0].torque_per_mille(), std::lround(0.1 / kRated_Nm * 1000));
  EXPECT_EQ(m.slave[1].torque_per_mille(), std::lround(-0.2 / kRated_Nm * 1000));
  EXPECT_NEAR(m.master.sent_torque_Nm()[1], -0.2, kRated_Nm / 2000);
  EXPECT_GT(m.master.feedback()[0].position_rad, 1000 * kRadPerCount);
  EXPECT_LT(m.master.feedback()[1].position_rad, 1000 * kRadPerCount);
}

TEST(DriveMaster, SendsRpdosThenSyncInOneBatch) {
  Machine m;
  m.BringUp();
  m.Cycle();
  ASSERT_GE(m.sent.size(), 3u);
  EXPECT_EQ(m.sent[0].frame.id, 0x201);
  EXPECT_EQ(m.sent[1].frame.id, 0x202);
  EXPECT_EQ(m.sent[2].frame.id, 0x080);
}

TEST(DriveMaster, TheHeartbeatIsOftenEnoughToMissTwo) {
  Machine m;
  m.BringUp();
  const std::uint64_t before = m.slave[0].master_heartbeats();
  m.Cycles(300);
  EXPECT_EQ(m.slave[0].master_heartbeats() - before, 100u);  // every 3 ms for a notice time of 10 ms
}

TEST(DriveMaster, ADriveThatRestartsIsNoticedAndBroughtUpAgain) {
  Machine m;
  m.BringUp();
  m.Reach(DriveGoal::kEnabled);
  m.Goal(DriveGoal::kQuickStop);
  m.slave[0].Restart(m.now_ns());
  m.Cycles(3);
  EXPECT_TRUE(m.master.status()[0].restarted);
  EXPECT_FALSE(m.master.operational());
  EXPECT_FALSE(m.master.feedback()[0].fresh);
  EXPECT_TRUE(m.master.feedback()[1].fresh) << "the other axis is still served";
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
  m.Reach(DriveGoal::kEnabled);
  EXPECT_TRUE(m.master.status()[0].at_goal);
}

TEST(DriveMaster, ADriveThatFallsSilentIsNoticed) {
  Machine m;
  m.BringUp();
  m.Cycles(100);
  m.slave[1].behaviour.silent = true;
  m.Cycles(145);
  EXPECT_FALSE(m.master.status()[1].heartbeat_lost);
  m.Cycles(6);
  EXPECT_TRUE(m.master.status()[1].heartbeat_lost);
  EXPECT_EQ(m.master.status()[1].nmt, NmtState::kUnknown);
  EXPECT_FALSE(m.master.status()[0].heartbeat_lost);
  EXPECT_FALSE(m.master.operational());
  m.slave[1].behaviour.silent = false;
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
  EXPECT_FALSE(m.master.status()[1].heartbeat_lost);
}

TEST(DriveMaster, FeedbackIsASignOfLifeToo) {
  Machine m;
  m.BringUp();
  m.slave[1].StopHeartbeat();
  m.Cycles(300);
  EXPECT_FALSE(m.master.status()[1].heartbeat_lost);
  EXPECT_TRUE(m.master.operational());
}

TEST(DriveMaster, ADriveThatLeavesOperationalIsNoticedByItsHeartbeat) {
  Machine m;
  m.BringUp();
  m.Cycles(5);
  m.slave[0].EnterPreOperational();
  m.Cycles(52);
  EXPECT_EQ(m.master.status()[0].nmt, NmtState::kPreOperational);
  EXPECT_FALSE(m.master.operational());
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
}

TEST(DriveMaster, FeedbackAgesWhenItDoesNotCome) {
  Machine m;
  m.BringUp();
  m.Cycles(3);
  m.slave[0].behaviour.silent = true;
  m.Cycles(5);
  EXPECT_FALSE(m.master.feedback()[0].fresh);
  EXPECT_TRUE(m.master.feedback()[0].valid);
  EXPECT_EQ(m.master.feedback()[0].age_cycles, 5u);
  m.Skip(3);
  m.Cycle();
  EXPECT_EQ(m.master.feedback()[0].age_cycles, 9u) << "skipped grid points are time gone by";
  EXPECT_EQ(m.master.feedback()[1].age_cycles, 0u);
}

TEST(DriveMaster, AFaultIsSeenRecordedAndReset) {
  Machine m;
  m.BringUp();
  m.Reach(DriveGoal::kEnabled);
  m.slave[0].Fault(0x3210);
  m.Cycles(3);
  EXPECT_TRUE(m.master.status()[0].fault);
  EXPECT_TRUE(m.master.status()[0].left_enabled);
  EXPECT_EQ(m.master.status()[0].emergency_code, 0x3210);
  EXPECT_FALSE(m.master.status()[1].fault);
  EXPECT_EQ(m.master.sent_torque_Nm()[0], 0.0);
  m.Goal(DriveGoal::kQuickStop);
  m.Cycles(5);
  EXPECT_LT(m.Reach(DriveGoal::kFaultReset), 20);
  EXPECT_FALSE(m.master.status()[0].fault);
  m.Reach(DriveGoal::kEnabled);
  EXPECT_EQ(m.slave[0].state(), DriveState::kOperationEnabled);
}

TEST(DriveMaster, ADriveThatLeavesEnabledByItselfStaysSo) {
  Machine m;
  m.BringUp();
  m.Reach(DriveGoal::kEnabled);
  m.setpoints[0].torque_Nm = 0.5;
  m.Cycles(3);
  m.slave[0].LeaveEnabled();
  m.Cycles(5);
  EXPECT_TRUE(m.master.status()[0].left_enabled);
  EXPECT_NE(m.slave[0].state(), DriveState::kOperationEnabled);
  EXPECT_EQ(m.master.sent_torque_Nm()[0], 0.0);
}

TEST(DriveMaster, AQuickStopSendsNoTorque) {
  Machine m;
  m.BringUp();
  m.Reach(DriveGoal::kEnabled);
  for (AxisSetpoint& s : m.setpoints) s = {DriveGoal::kQuickStop, 1.0, 0.0};
  m.Cycle();
  EXPECT_EQ(m.sent[0].frame, (CanFrame{0x201, 4, {0x02, 0x00, 0x00, 0x00}}));
  m.Cycles(5);
  EXPECT_EQ(m.slave[0].state(), DriveState::kSwitchOnDisabled);
  EXPECT_TRUE(m.master.status()[0].at_goal);
  EXPECT_FALSE(m.master.busy());
}

TEST(DriveMaster, SaysInWhichStateADriveStayed) {
  Machine m;
  m.slave[1].behaviour.stuck_in = DriveState::kReadyToSwitchOn;
  m.BringUp();
  m.Reach(DriveGoal::kEnabled, 600);
  EXPECT_TRUE(m.master.status()[0].at_goal);
  EXPECT_TRUE(m.master.status()[1].transition_late);
  EXPECT_EQ(m.master.status()[1].stuck_in, DriveState::kReadyToSwitchOn);
}

TEST(DriveMaster, TorqueIsLimitedAndNeverNotANumber) {
  Machine m;
  m.BringUp();
  m.Reach(DriveGoal::kEnabled);
  m.setpoints[0].torque_Nm = 99.0;
  m.setpoints[1].torque_Nm = std::nan("");
  m.Cycles(3);
  EXPECT_EQ(m.slave[0].torque_per_mille(), std::lround(1.5 / kRated_Nm * 1000));
  EXPECT_EQ(m.slave[1].torque_per_mille(), 0);
  EXPECT_NEAR(m.master.sent_torque_Nm()[0], 1.5, kRated_Nm / 2000);
}

TEST(DriveMaster, InCspTheTargetStaysAtTheAxisUntilItIsEnabled) {
  MasterConfig config = TwoAxes();
  for (AxisDriveConfig& a : config.axes) a.drive.mode = DriveMode::kCsp;
  Machine m(config);
  m.BringUp();
  ASSERT_TRUE(m.master.operational());
  EXPECT_EQ((m.slave[0].objects()[{0x1600, 0}]), 3u);
  for (AxisSetpoint& s : m.setpoints) s.position_rad = 1.0;
  m.Reach(DriveGoal::kSwitchedOn);
  m.Cycles(3);
  EXPECT_EQ(m.slave[0].target_position(), 1000);
  m.Reach(DriveGoal::kEnabled);
  m.Cycles(3);
  EXPECT_EQ(m.slave[0].target_position(), std::lround(1.0 / kRadPerCount));
}

TEST(DriveMaster, PositionGoesOnOverTheWrapOfTheCounter) {
  Machine m;
  m.slave[0].set_position(std::int64_t{INT32_MAX} - 10);
  m.BringUp();
  m.Cycles(3);
  const double before = m.master.feedback()[0].position_rad;
  m.slave[0].set_position(std::int64_t{INT32_MAX} + 10);
  m.Cycles(3);
  EXPECT_NEAR(m.master.feedback()[0].position_rad - before, 20 * kRadPerCount, 1e-9);
}

TEST(DriveMaster, SurvivesNonsenseOnTheBus) {
  std::mt19937 random(3);
  DriveMaster master(TwoAxes());
  DriveMaster::Frames sent;
  PerAxis<AxisSetpoint> setpoints(2);
  for (AxisSetpoint& s : setpoints) s.goal = DriveGoal::kEnabled;
  CycleInput in;
  in.buses.push_back({});
  master.StartBringUp();
  constexpr std::uint16_t kBases[] = {0x000, 0x080, 0x180, 0x200, 0x280, 0x580, 0x600, 0x700};
  for (int cycle = 0; cycle < 20000; ++cycle) {
    in.cycle = static_cast<std::uint64_t>(cycle);
    in.frames.clear();
    for (std::size_t n = random() % kMaxFramesPerCycle; n > 0; --n) {
      StampedFrame f;
      f.bus = static_cast<std::uint8_t>(random() % 8 == 0 ? random() : 0);
      f.frame.id = static_cast<std::uint16_t>(kBases[random() % 8] + random() % 4);
      f.frame.length = static_cast<std::uint8_t>(random() % 9);
      for (auto& byte : f.frame.data) byte = static_cast<std::uint8_t>(random());
      // Now and then the right answer, so that it gets further than the first object.
      if (random() % 2 == 0 && !sent.empty() && (sent.back().frame.id & 0x780) == 0x600) {
        f.frame = sent.back().frame;
        f.frame.id = static_cast<std::uint16_t>(f.frame.id - 0x80);
        f.frame.data[0] = (f.frame.data[0] & 0xE0) == 0x20 ? 0x60 : 0x43;
        f.frame.length = 8;
      }
      in.frames.push_back(f);
    }
    master.Receive(in);
    sent.clear();
    master.Send(setpoints, sent);
    if (master.bring_up_failed() && cycle % 50 == 0) master.StartBringUp();
    for (const double torque : master.sent_torque_Nm()) ASSERT_EQ(torque, 0.0);
  }
}

TEST(DriveMaster, TouchesNoHeap) {
  if (!AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  DriveMaster master(TwoAxes());
  DriveMaster::Frames sent;
  PerAxis<AxisSetpoint> setpoints(2);
  CycleInput in;
  in.buses.push_back({});
  in.frames.push_back({HeartbeatFrame(1, NmtState::kBootUp), 0, 0});
  in.frames.push_back({SdoWriteFrame(1, 0x1000, 0, 4, 0), 0, 0});
  const AllocationGuard guard;
  master.StartBringUp();
  for (int i = 0; i < 2000; ++i) {
    in.cycle = static_cast<std::uint64_t>(i);
    master.Receive(in);
    sent.clear();
    master.Send(setpoints, sent);
  }
  EXPECT_EQ(guard.calls(), 0u);
  EXPECT_TRUE(master.bring_up_failed());
}

TEST(DriveMaster, RefusesNonsense) {
  const auto refused = [](auto&& change) {
    MasterConfig c = TwoAxes();
    change(c);
    try {
      DriveMaster master(c);
      return std::string();
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
  };
  EXPECT_EQ(refused([](MasterConfig&) {}), "");
  EXPECT_NE(refused([](MasterConfig& c) { c.axes[1].drive.node_id = 1; }).find("already that of axis x"),
            std::string::npos);
  EXPECT_NE(refused([](MasterConfig& c) { c.axes[1].drive.node_id = 127; }).find("master's own"),
            std::string::npos);
  EXPECT_NE(refused([](MasterConfig& c) { c.axes[0].torque_limit_Nm = 2.0; }).find("exceeds peak_torque_Nm"),
            std::string::npos);
  EXPECT_NE(refused([](MasterConfig& c) { c.axes[0].bus = 1; }).find("bus"), std::string::npos);
  EXPECT_NE(refused([](MasterConfig& c) { c.cycle_us = 1234; }).find("0x60C2"), std::string::npos);
  EXPECT_NE(refused([](MasterConfig& c) { c.cycle_us = 8000; }).find("notice_ms"), std::string::npos);
  EXPECT_NE(refused([](MasterConfig& c) { c.axes.clear(); }), "");
}

}  // namespace
}  // namespace contour::test
