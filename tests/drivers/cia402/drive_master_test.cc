#include "drivers/cia402/drive_master.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/can/loopback_bus.h"
#include "tests/drivers/cia402/fake_slave.h"
#include "tests/support/allocation_guard.h"

namespace contour::test {
namespace {

constexpr double kRated_Nm = 0.637;
constexpr double kRadPerCount = 2.0 * std::numbers::pi / 1048576.0;

DriveConfig Drive(int node_id) {
  DriveConfig d;
  d.bus = "main";
  d.node_id = node_id;
  d.rated_torque_Nm = kRated_Nm;
  d.peak_torque_Nm = 1.91;
  d.encoder_counts_per_rev = 1048576;
  d.identity = IdentityConfig{0x1234, 0x5678, 1};
  return d;
}

MasterConfig TwoAxes() {
  MasterConfig c;
  c.axes = {{"x", 0, Drive(1), 1.5}, {"y", 0, Drive(2), 1.5}};
  BusConfig bus;
  bus.interface = "loopback";
  c.buses = {bus};
  return c;
}

/// Master and two fake slaves on a loopback bus; one Cycle is one millisecond.
class Machine {
 public:
  explicit Machine(const MasterConfig& config = TwoAxes())
      : master(config), setpoints(config.axes.size()), bus_(1'000'000, {&slave[0], &slave[1]}) {}

  void Cycle() {
    CycleInput& in = input_;
    in.cycle = ++cycle_;
    in.grid_time_ns = now_ns();
    in.frames.clear();
    in.buses.clear();
    std::array<StampedFrame, kMaxFramesPerCycle> received;
    const std::size_t n = bus_.Receive(now_ns(), received);
    for (std::size_t i = 0; i < n; ++i) {
      received[i].stamp_ns += stamp_offset_ns;
      in.frames.push_back(received[i]);
    }
    in.buses.push_back({bus_.State().up, false, 0});
    master.Receive(in);
    sent.clear();
    master.Send(setpoints, sent);
    for (const StampedFrame& f : sent) bus_.Send(now_ns(), std::span(&f.frame, 1));
  }
  void Cycles(int n) {
    for (int i = 0; i < n; ++i) Cycle();
  }
  /// Runs until bringing up has ended one way or the other.
  void BringUp() {
    master.StartBringUp();
    for (int i = 0; i < 5000 && !master.operational() && !master.bring_up_failed(); ++i) Cycle();
  }
  void Goal(DriveGoal goal) {
    for (AxisSetpoint& s : setpoints) s.goal = goal;
  }
  /// Cycles until both drives are at the goal, at most `limit`.
  int Reach(DriveGoal goal, int limit = 100) {
    Goal(goal);
    int n = 0;
    do {
      Cycle();
      ++n;
    } while (n < limit && !(master.status()[0].at_goal && master.status()[1].at_goal));
    return n;
  }
  [[nodiscard]] std::int64_t now_ns() const { return static_cast<std::int64_t>(cycle_) * 1'000'000; }
  [[nodiscard]] BringUpError error() const { return static_cast<BringUpError>(master.bring_up().error); }
  void SetLink(bool up) { bus_.SetLink(now_ns(), up); }
  void Skip(std::uint64_t cycles) { cycle_ += cycles; }

  std::array<FakeSlave, 2> slave{FakeSlave(1), FakeSlave(2)};
  DriveMaster master;
  PerAxis<AxisSetpoint> setpoints;
  DriveMaster::Frames sent;
  std::int64_t stamp_offset_ns = 0;

 private:
  LoopbackBus bus_;
  CycleInput input_;
  std::uint64_t cycle_ = 0;
};

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

/// The position is that of the SYNC which the master says has latched it.
void ExpectLatchedBy(const Machine& m, std::uint64_t sync) {
  EXPECT_EQ(m.master.feedback_sync(), sync);
  ASSERT_LE(sync, m.slave[0].latched.size());
  const auto latched = static_cast<double>(m.slave[0].latched[sync - 1]);
  EXPECT_NEAR(m.master.feedback()[0].position_rad, latched * kRadPerCount, 1e-12);
}

/// Enabled and moving, so that no two SYNCs latch the same position.
void BringToMotion(Machine& m) {
  m.BringUp();
  m.Reach(DriveGoal::kSwitchedOn);
  m.Reach(DriveGoal::kEnabled);
  m.setpoints[0].torque_Nm = 0.1;
  m.Cycles(10);
  ExpectLatchedBy(m, m.master.sync_number() - 1);
  ASSERT_NE(m.slave[0].latched.back(), m.slave[0].latched.end()[-2]);
}

TEST(DriveMaster, AnAnswerThatCameTooLateBelongsToTheSyncBefore) {
  Machine m;
  BringToMotion(m);
  // From now on every answer comes just after the grid point, before the next SYNC is sent.
  m.slave[0].behaviour.tpdo_ns = m.slave[1].behaviour.tpdo_ns = 750'000;
  m.Cycle();  // without one
  EXPECT_FALSE(m.master.feedback()[0].fresh);
  for (int late = 1; late < 4; ++late) {
    m.Cycle();
    ExpectLatchedBy(m, m.master.sync_number() - 2);
    EXPECT_FALSE(m.master.feedback()[0].fresh);
    EXPECT_EQ(m.master.feedback()[0].age_cycles, static_cast<std::uint32_t>(late + 1));
  }
  // In time again: two answers in one cycle, and the second is the new one.
  m.slave[0].behaviour.tpdo_ns = m.slave[1].behaviour.tpdo_ns = 20'000;
  m.Cycles(2);
  for (int i = 0; i < 3; ++i, m.Cycle()) {
    ExpectLatchedBy(m, m.master.sync_number() - 1);
    EXPECT_TRUE(m.master.feedback()[0].fresh);
  }
}

TEST(DriveMaster, AnAnswerInTimeAfterALostOneBelongsToTheNewestSync) {
  Machine m;
  BringToMotion(m);
  m.slave[0].behaviour.unanswered = m.slave[1].behaviour.unanswered = true;
  m.Cycles(2);
  EXPECT_FALSE(m.master.feedback()[0].fresh);
  m.slave[0].behaviour.unanswered = m.slave[1].behaviour.unanswered = false;
  m.Cycles(2);
  EXPECT_TRUE(m.master.feedback()[0].fresh);
  ExpectLatchedBy(m, m.master.sync_number() - 1);
}

TEST(DriveMaster, StampsOfAnotherClockSayNothing) {
  Machine m;
  m.stamp_offset_ns = 5'000'000'000;
  BringToMotion(m);
  m.slave[0].behaviour.unanswered = m.slave[1].behaviour.unanswered = true;
  m.Cycles(2);
  m.slave[0].behaviour.unanswered = m.slave[1].behaviour.unanswered = false;
  m.stamp_offset_ns = -5'000'000'000;
  m.Cycles(2);
  EXPECT_TRUE(m.master.feedback()[0].fresh);
  ExpectLatchedBy(m, m.master.sync_number() - 1);
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

TEST(DriveMaster, TheDriveHoldsWhatWasConfigured) {
  MasterConfig config = TwoAxes();
  config.axes[0].drive.quick_stop_deceleration_rad_s2 = 1000.0;
  Machine m(config);
  m.BringUp();
  ASSERT_TRUE(m.master.operational());
  auto& o = m.slave[0].objects();
  EXPECT_EQ((o[{0x1016, 1}]), (127u << 16) | 10u);
  EXPECT_EQ((o[{0x1017, 0}]), 50u);
  EXPECT_EQ((o[{0x1006, 0}]), 1000u);
  EXPECT_EQ((o[{0x60C2, 1}]), 1u);
  EXPECT_EQ((o[{0x60C2, 2}]), 0xFDu);  // 10^-3
  EXPECT_EQ((o[{0x6007, 0}]), 3u);
  EXPECT_EQ((o[{0x605A, 0}]), 2u);
  EXPECT_NEAR((o[{0x6085, 0}]), 1000.0 / (2 * std::numbers::pi) * 1048576, 1);
  EXPECT_EQ((o[{0x6072, 0}]), 2355u);  // 1.5 Nm of 0.637 Nm, rounded up
  EXPECT_EQ((o[{0x1400, 5}]), 10u);
  EXPECT_EQ((o[{0x1400, 1}]), 0x201u);
  EXPECT_EQ((o[{0x1400, 2}]), 1u);
  EXPECT_EQ((o[{0x1600, 0}]), 2u);
  EXPECT_EQ((o[{0x1600, 2}]), 0x60710010u);
  EXPECT_EQ((o[{0x1800, 2}]), 1u);
  EXPECT_EQ((o[{0x1A00, 0}]), 3u);
  EXPECT_EQ((o[{0x1A00, 2}]), 0x60640020u);
  EXPECT_EQ((o[{0x1801, 1}]) >> 31, 1u) << "what is not used is switched off";
  EXPECT_EQ((o[{0x6060, 0}]), 10u);
}

TEST(DriveMaster, PdosAreConfiguredInTheOrderOfCia301) {
  Machine m;
  m.BringUp();
  using Object = FakeSlave::Object;
  std::vector<Object> tpdo;
  for (const Object& o : m.slave[0].writes()) {
    if (o.first == 0x1800 || o.first == 0x1A00) tpdo.push_back(o);
  }
  EXPECT_EQ(tpdo, (std::vector<Object>{{0x1800, 1},
                                       {0x1A00, 0},
                                       {0x1A00, 1},
                                       {0x1A00, 2},
                                       {0x1A00, 3},
                                       {0x1A00, 0},
                                       {0x1800, 2},
                                       {0x1800, 1}}));
}

TEST(DriveMaster, NothingCyclicIsSentBeforeAllDrivesAreUp) {
  Machine m;
  m.master.StartBringUp();
  int sdos = 0;
  for (int i = 0; i < 5000 && !m.master.operational(); ++i) {
    m.Cycle();
    int sdos_of_cycle = 0;
    for (const StampedFrame& f : m.sent) {
      const bool sdo = f.frame.id > 0x600 && f.frame.id < 0x680;
      const bool nmt = f.frame.id == 0;
      EXPECT_TRUE(sdo || nmt || f.frame.id == 0x77F || m.master.operational()) << std::hex << f.frame.id;
      sdos_of_cycle += sdo ? 1 : 0;
    }
    EXPECT_LE(sdos_of_cycle, 1);
    sdos += sdos_of_cycle;
  }
  EXPECT_GT(sdos, 100);
  EXPECT_EQ(m.master.bring_up().phase, static_cast<std::uint8_t>(BringUpPhase::kOperational));
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

TEST(DriveMaster, FindsADriveThatSendsNoBootUp) {
  Machine m;
  m.slave[1].behaviour.boot_up = false;
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
}

TEST(DriveMaster, ADriveThatStartsItselfIsNoError) {
  Machine m;
  m.slave[0].behaviour.self_start = true;
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
}

TEST(DriveMaster, ASilentDriveIsNamedWithHowLongItWaited) {
  Machine m;
  m.slave[1].behaviour.silent = true;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kNoAnswer);
  const BringUpStatus s = m.master.bring_up();
  EXPECT_EQ(s.axis, 1);
  EXPECT_EQ(s.node_id, 2);
  EXPECT_EQ(s.waited_us, 1'200'000u);  // boot_up_ms and sdo_ms
  EXPECT_EQ(s.index, 0x1000);
  EXPECT_FALSE(m.master.busy());
}

TEST(DriveMaster, AnObjectThatIsNotAnsweredIsNamed) {
  Machine m;
  m.slave[0].behaviour.mute_object = {0x1A00, 2};
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kSdoTimeout);
  EXPECT_EQ(m.master.bring_up().index, 0x1A00);
  EXPECT_EQ(m.master.bring_up().sub_index, 2);
  EXPECT_EQ(m.master.bring_up().phase, static_cast<std::uint8_t>(BringUpPhase::kPdo));
  EXPECT_EQ(m.master.bring_up().waited_us, 200'000u);
}

TEST(DriveMaster, AnAbortIsReportedWithItsCode) {
  Machine m;
  m.slave[0].behaviour.aborts[{0x1A00, 2}] = 0x06040041;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kSdoAbort);
  EXPECT_EQ(m.master.bring_up().abort_code, 0x06040041u);
  EXPECT_EQ(m.master.bring_up().index, 0x1A00);
}

TEST(DriveMaster, ATransmissionTypeThatDoesNotTakeIsFoundByReadBack) {
  Machine m;
  m.slave[1].behaviour.sticky[{0x1800, 2}] = 254;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kReadBack);
  const BringUpStatus s = m.master.bring_up();
  EXPECT_EQ(s.axis, 1);
  EXPECT_EQ(s.index, 0x1800);
  EXPECT_EQ(s.sub_index, 2);
  EXPECT_EQ(s.expected, 1u);
  EXPECT_EQ(s.found, 254u);
}

TEST(DriveMaster, AnotherDriveThanConfiguredIsRefused) {
  Machine m;
  m.slave[0].objects()[{0x1018, 2}] = 0x9999;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kIdentity);
  EXPECT_EQ(m.master.bring_up().expected, 0x5678u);
  EXPECT_EQ(m.master.bring_up().found, 0x9999u);
}

TEST(DriveMaster, ADeviceThatIsNoDriveIsRefused) {
  Machine m;
  m.slave[0].objects()[{0x1000, 0}] = 0x000F0191;  // an I/O module
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kNotADrive);
  EXPECT_EQ(m.master.bring_up().found, 401u);
}

TEST(DriveMaster, RatedTorqueMustAgreeAndMustNotBeZero) {
  Machine zero;
  zero.slave[0].objects()[{0x6076, 0}] = 0;
  zero.BringUp();
  EXPECT_EQ(zero.error(), BringUpError::kRatedTorqueZero);
  Machine other;
  other.slave[0].objects()[{0x6076, 0}] = 1270;
  other.BringUp();
  EXPECT_EQ(other.error(), BringUpError::kRatedTorque);
  EXPECT_EQ(other.master.bring_up().expected, 637u);
  EXPECT_EQ(other.master.bring_up().found, 1270u);
}

TEST(DriveMaster, ResolutionGearAndPolarityMustAgree) {
  Machine encoder;
  encoder.slave[0].objects()[{0x608F, 1}] = 131072;
  encoder.BringUp();
  EXPECT_EQ(encoder.error(), BringUpError::kUnits);
  EXPECT_EQ(encoder.master.bring_up().found, 131072u);
  Machine per_ten_turns;
  per_ten_turns.slave[0].objects()[{0x608F, 1}] = 10485760;
  per_ten_turns.slave[0].objects()[{0x608F, 2}] = 10;
  per_ten_turns.BringUp();
  EXPECT_TRUE(per_ten_turns.master.operational()) << "the ratio counts";
  Machine gear;
  gear.slave[0].objects()[{0x6091, 1}] = 3;
  gear.BringUp();
  EXPECT_EQ(gear.error(), BringUpError::kUnits);
  Machine inverted;
  inverted.slave[0].objects()[{0x607E, 0}] = 0xC0;
  inverted.BringUp();
  EXPECT_EQ(inverted.error(), BringUpError::kUnits);
  EXPECT_EQ(inverted.master.bring_up().index, 0x607E);
}

TEST(DriveMaster, ADriveWithoutOptionalObjectsIsTaken) {
  Machine m;
  for (FakeSlave& s : m.slave) {
    for (const int index :
         {0x605A, 0x605B, 0x605C, 0x605D, 0x605E, 0x607E, 0x6502, 0x60E0, 0x60E1, 0x1006, 0x1015}) {
      s.objects().erase({static_cast<std::uint16_t>(index), 0});
    }
    s.objects().erase({0x1400, 5});  // no RPDO timeout: the heartbeat consumer serves
    s.objects().erase({0x1029, 1});
    s.objects().erase({0x60C2, 1});
    s.objects().erase({0x60C2, 2});
    s.objects().erase({0x6091, 1});
    s.objects().erase({0x608F, 1});
    s.behaviour.read_only[{0x6072, 0}] = 0x06010002;
    s.objects()[{0x6072, 0}] = 3000;
  }
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << std::hex << m.master.bring_up().index;
}

TEST(DriveMaster, ADriveThatCannotNoticeALostMasterIsRefused) {
  Machine m;
  m.slave[0].objects().erase({0x1016, 1});
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << "the RPDO timeout serves";
  Machine neither;
  neither.slave[0].objects().erase({0x1016, 1});
  neither.slave[0].objects().erase({0x1400, 5});
  neither.BringUp();
  EXPECT_EQ(neither.error(), BringUpError::kNoLossDetection);
}

TEST(DriveMaster, ATorqueLimitInTheDriveBelowOursIsRefused) {
  Machine m;
  m.slave[0].behaviour.read_only[{0x6072, 0}] = 0x06010002;
  m.slave[0].objects()[{0x6072, 0}] = 1000;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kLimitTooLow);
  EXPECT_EQ(m.master.bring_up().expected, 2355u);
}

TEST(DriveMaster, AModeThatIsNotShownIsReported) {
  Machine m;
  m.slave[0].behaviour.sticky[{0x6060, 0}] = 0;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kModeNotTaken);
  EXPECT_EQ(m.master.bring_up().expected, 10u);
  EXPECT_GE(m.master.bring_up().waited_us, 500'000u);
  Machine unsupported;
  unsupported.slave[0].objects()[{0x6502, 0}] = 0x80;  // CSP only
  unsupported.BringUp();
  EXPECT_EQ(unsupported.error(), BringUpError::kModeNotSupported);
}

TEST(DriveMaster, ADriveThatStaysPreOperationalIsReported) {
  Machine m;
  m.slave[1].behaviour.stays_pre_operational = true;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kNotOperational);
  EXPECT_EQ(m.master.bring_up().axis, 1);
  EXPECT_EQ(m.master.bring_up().found, 0x7Fu);
  EXPECT_EQ(m.master.sync_number(), 0u);
}

TEST(DriveMaster, ADriveThatRestartsWhileBroughtUpIsReported) {
  Machine m;
  m.master.StartBringUp();
  m.Cycles(60);
  ASSERT_TRUE(m.master.busy());
  m.slave[0].Restart(m.now_ns());
  for (int i = 0; i < 100 && !m.master.bring_up_failed(); ++i) m.Cycle();
  EXPECT_EQ(m.error(), BringUpError::kRestarted);
}

TEST(DriveMaster, TheBusGoingDownWhileBroughtUpIsReportedAndRecoverable) {
  Machine m;
  m.master.StartBringUp();
  m.Cycles(40);
  m.SetLink(false);
  m.Cycles(2);
  EXPECT_EQ(m.error(), BringUpError::kBusDown);
  m.SetLink(true);
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
}

TEST(DriveMaster, ADriveThatFailedIsBroughtUpByTheNextAttempt) {
  Machine m;
  m.slave[1].behaviour.silent = true;
  m.BringUp();
  ASSERT_TRUE(m.master.bring_up_failed());
  m.slave[1].behaviour.silent = false;
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
  EXPECT_EQ(m.error(), BringUpError::kNone);
}

TEST(DriveMaster, BringingUpHealthyDrivesAgainDoesNothing) {
  Machine m;
  m.BringUp();
  m.Cycles(5);
  const auto writes = m.slave[0].writes().size();
  m.master.StartBringUp();
  EXPECT_TRUE(m.master.operational());
  m.Cycles(5);
  EXPECT_EQ(m.slave[0].writes().size(), writes);
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
