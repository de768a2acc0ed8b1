// Which SYNC an answer belongs to, and by how much it came late.
#include "drivers/cia402/drive_master.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drivers/can/frame_timing.h"
#include "tests/drivers/cia402/two_drives.h"

namespace contour::test {
namespace {

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

// Two drives with one node number: one TPDO of each comes after every SYNC.
TEST(DriveMaster, MoreAnswersThanSyncsAreThoseOfTwoDrives) {
  Machine m;
  m.BringUp();
  m.Cycles(100);
  ASSERT_NE(m.master.status()[1].answers, AnswerFault::kTwice);
  CanFrame other{0x182, 8, {}};
  PutU16(other, 0, 0x0233);
  int cycles = 0;
  while (m.master.status()[1].answers != AnswerFault::kTwice && cycles < 200) {
    m.Inject(other);
    m.Cycle();
    ++cycles;
  }
  EXPECT_LE(cycles, 34);
  EXPECT_NE(m.master.status()[0].answers, AnswerFault::kTwice);
  m.Cycles(5);
  EXPECT_EQ(m.master.status()[1].answers, AnswerFault::kTwice) << "until it is brought up";
  m.BringUp();
  m.Cycles(100);
  EXPECT_NE(m.master.status()[1].answers, AnswerFault::kTwice);
}

TEST(DriveMaster, AnswersThatWereHeldUpAreStillThoseOfOneDrive) {
  Machine m;
  m.BringUp();
  for (const int held : {1, 2, 3, 4, 5, 6, 9, 14, 20, 40})
    for (int again = 0; again < 20; ++again) {
      m.slave[0].behaviour.tpdo_ns = 1'000'000 * (held + 1);
      m.Cycles(held);
      m.slave[0].behaviour.tpdo_ns = 20'000;
      for (int i = 0; i < 7 + held; ++i) {
        m.Cycle();
        ASSERT_NE(m.master.status()[0].answers, AnswerFault::kTwice) << held;
      }
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

// A SYNC that waits for another frame is late, and so is what answers it.
TEST(DriveMaster, AnAnswerSaysByHowMuchLaterThanUsualItCame) {
  test::Machine m;
  m.BringUp();
  ASSERT_TRUE(m.master.operational());
  const auto usual = [&] {
    int n = 0;
    for (int i = 0; i < 200; ++i) {
      m.Cycle();
      n += std::abs(m.master.feedback()[0].late_s) < 15e-6 ? 1 : 0;
    }
    return n;
  };
  m.Cycles(1000);
  EXPECT_GT(usual(), 100) << "stuff bits, and now and then a frame of the master's";
  m.stamp_offset_ns = 300'000;
  m.Cycle();
  EXPECT_NEAR(m.master.feedback()[0].late_s, 300e-6, 120e-6);
  EXPECT_NEAR(m.master.feedback()[1].late_s, 300e-6, 120e-6);
  m.stamp_offset_ns = 0;
  EXPECT_GT(usual(), 100);
  // What goes on being later is usual in the end; stamps of another clock say nothing.
  m.stamp_offset_ns = 300'000;
  m.Cycles(1000);
  EXPECT_GT(usual(), 100);
  m.stamp_offset_ns = 1'000'000'000'000;
  m.Cycle();
  EXPECT_EQ(m.master.feedback()[0].late_s, 0.0);
}

// Two frames of others: one holds up the SYNC, the other only what answers it.
TEST(DriveMaster, ASyncOfItsOwnOnTheWireSaysByHowMuchLaterItCame) {
  Machine m;
  m.TellOfSync();
  m.BringUp();
  ASSERT_TRUE(m.master.operational());
  EXPECT_EQ(m.master.second_master(), DriveMaster::kNoBus) << "our own is no other master's";
  m.Cycles(1000);
  constexpr CanFrame kLong{0x4FE, 8, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55}};
  const double frame_s = 1e-9 * static_cast<double>(BitsToNs(FrameBits(kLong), 1'000'000));
  const auto& f = m.master.feedback()[0];
  // The master's own frames of now and then come behind the SYNC.
  double most_s = 0.0;
  for (int i = 0; i < 200; ++i, m.Cycle()) most_s = std::max(most_s, std::abs(f.sync_late_s));
  EXPECT_LT(most_s, 0.25 * frame_s);
  m.BeginFrame(kLong);
  m.Cycles(2);
  EXPECT_NEAR(f.sync_late_s, frame_s, 0.25 * frame_s);
  m.Cycle();
  EXPECT_LT(std::abs(f.sync_late_s), 0.25 * frame_s);
  // What is on the wire is known by its own stamp, whatever the answer's says.
  m.slave[0].behaviour.tpdo_ns = 300'000;
  m.Cycles(2);
  EXPECT_GT(f.late_s, 100e-6);
  EXPECT_LT(std::abs(f.sync_late_s), 0.25 * frame_s);
}

TEST(DriveMaster, InEitherModeItIsKnownHowFarTwoSyncsWereApart) {
  for (const DriveMode mode : {DriveMode::kCst, DriveMode::kCsp}) {
    MasterConfig config = TwoAxes();
    for (AxisDriveConfig& a : config.axes) a.drive.mode = mode;
    Machine m(config);
    m.TellOfSync();
    m.BringUp();
    ASSERT_TRUE(m.master.operational());
    m.Cycles(1000);
    constexpr CanFrame kLong{0x4FE, 8, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55}};
    const double frame_s = 1e-9 * static_cast<double>(BitsToNs(FrameBits(kLong), 1'000'000));
    const auto apart_s = [&](std::size_t i) { return m.master.SyncApart_s(i); };
    EXPECT_LT(apart_s(0), 0.25 * frame_s);
    m.BeginFrame(kLong);
    m.Cycles(2);
    for (const std::size_t i : {0U, 1U}) EXPECT_NEAR(apart_s(i), frame_s, 0.25 * frame_s);
    m.Cycle();
    EXPECT_NEAR(apart_s(0), -frame_s, 0.25 * frame_s) << "nearer than a cycle";
    m.BeginFrame(kLong);
    m.Cycle();
    m.BeginFrame(kLong);
    m.Cycles(2);
    EXPECT_LT(apart_s(0), 0.25 * frame_s) << "both were late";
    m.stamp_offset_ns = 1'000'000'000'000;
    m.BeginFrame(kLong);
    m.Cycles(2);
    EXPECT_EQ(apart_s(0), 0.0) << "stamps of another clock";
  }
}

/// Cycles with SYNCs left out until it is known which ones are answered.
int Probe(Machine& m) {
  int left_out = 0;
  m.Cycles(6);
  for (int i = 0; i < 200 && m.master.ProbesAnswers(); ++i) {
    m.Cycle();
    left_out += m.SentSync() ? 0 : 1;
  }
  EXPECT_FALSE(m.master.ProbesAnswers());
  return left_out;
}

TEST(DriveMaster, AnswersThatAreLateFromTheStartAreToldFromThoseInTime) {
  for (const std::int64_t late_ns : {750'000, 1'020'000, 1'700'000, 2'020'000, 3'100'000}) {
    Machine m;
    m.slave[1].behaviour.tpdo_ns = late_ns;
    m.BringUp();
    EXPECT_EQ(Probe(m), AnswerProbe::kTries);
    EXPECT_NE(m.master.status()[0].answers, AnswerFault::kLate);
    EXPECT_EQ(m.master.status()[1].answers, AnswerFault::kLate) << late_ns;
    // Until it is brought up.
    m.slave[1].behaviour.tpdo_ns = 20'000;
    m.Cycles(100);
    EXPECT_EQ(m.master.status()[1].answers, AnswerFault::kLate);
    m.BringUp();
    EXPECT_EQ(Probe(m), 0);
    EXPECT_NE(m.master.status()[1].answers, AnswerFault::kLate);
  }
}

TEST(DriveMaster, ADriveThatAnswersFromALaterSyncOnIsNotLate) {
  for (const int without : {2, 3, 7, 40}) {
    Machine m;
    m.slave[0].behaviour.unanswered = true;
    m.BringUp();
    m.Cycles(without);
    m.slave[0].behaviour.unanswered = false;
    EXPECT_EQ(Probe(m), 1) << without;
    EXPECT_NE(m.master.status()[0].answers, AnswerFault::kLate);
  }
}

// A busy host: the first answers are held up, and come together or one a cycle behind for a while.
TEST(DriveMaster, AnswersThatWereHeldUpAtFirstAreNotLate) {
  for (const int held : {1, 3, 9, 12, 25}) {
    Machine m;
    m.slave[0].behaviour.tpdo_ns = m.slave[1].behaviour.tpdo_ns = 1'020'000;
    m.BringUp();
    m.Cycles(held);
    m.slave[0].behaviour.tpdo_ns = m.slave[1].behaviour.tpdo_ns = 20'000;
    EXPECT_LE(Probe(m), AnswerProbe::kTries);
    for (const AxisDriveStatus& s : m.master.status()) EXPECT_NE(s.answers, AnswerFault::kLate) << held;
  }
  // And now and then one is, throughout.
  for (int every = 2; every < 12; ++every) {
    Machine m;
    m.slave[0].behaviour.tpdo_ns = 1'020'000;
    m.BringUp();
    for (int i = 0; i < 200; ++i) {
      m.slave[0].behaviour.tpdo_ns = i % every == 0 ? 1'020'000 : 20'000;
      m.Cycle();
    }
    EXPECT_FALSE(m.master.ProbesAnswers());
    EXPECT_NE(m.master.status()[0].answers, AnswerFault::kLate) << every;
  }
}

TEST(DriveMaster, AnswersInTimeCostNoSync) {
  Machine m;
  m.BringUp();
  EXPECT_FALSE(m.master.ProbesAnswers());
  m.Cycles(2);
  for (int i = 0; i < 100; ++i, m.Cycle()) {
    ASSERT_FALSE(m.master.ProbesAnswers());
    ASSERT_TRUE(m.SentSync());
  }
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

}  // namespace
}  // namespace contour::test
