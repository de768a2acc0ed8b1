// What the emulated drives do when the master falls silent, and what time means then.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/plant_emulator/drive_harness.h"

namespace contour::test {
namespace {

constexpr double kSpeed_m_s = 0.05;

enum class Watch { kHeartbeat, kRpdo };

/// An axis in motion under constant torque, watched in one of two ways; then the master says nothing any
/// more.
struct Silence {
  Silence(Watch watch, EmulatedClock clock, std::int64_t abort_option = 3)
      : h(NominalMachine(), {Place("x", 1)}, clock) {
    h.BringUp();
    h.Nmt(0x80);
    h.Expect(1, 0x6007, 0, 2, abort_option);
    h.Expect(1, 0x6085, 0, 4, std::llround(10.0 * 1048576 / 5e-3));
    if (watch == Watch::kHeartbeat) {
      h.Expect(1, 0x1016, 1, 4, 127 << 16 | 10);
    } else {
      h.Expect(1, 0x1400, 5, 2, 10);
    }
    h.Nmt(0x01);
    h.Enable();
    for (int k = 0; k < 3000 && truth().table_velocity_m_s < kSpeed_m_s; ++k) Cycle();
    EXPECT_EQ(h.status(1) & 0x6F, 0x27);
    from = truth();
    began_s = h.machine.truth().time_s;
    h.seen.clear();
  }
  void Cycle() {
    if (h.now_ns % 4'000'000 < 1'000'000) h.Heartbeat();
    h.Cycle(0x0F, 150);
  }
  const AxisTruth& truth() { return h.machine.truth().axes[0]; }

  DriveHarness h;
  AxisTruth from;
  double began_s = 0.0;
};

void ExpectStopsByItself(Silence& s, std::uint16_t code) {
  s.h.RunTimers(1'500'000'000);
  EXPECT_EQ(s.truth().drive_state, DriveState::kSwitchOnDisabled);
  EXPECT_EQ(s.truth().command_Nm, 0.0);
  EXPECT_NEAR(s.truth().torque_Nm, 0.0, 1e-9);
  EXPECT_NEAR(s.truth().table_velocity_m_s, 0.0, 1e-6);
  ASSERT_FALSE(s.h.Emergencies(1).empty());
  EXPECT_EQ(s.h.Emergencies(1).front(), code);
  // Travel: at most 11 ms under the last torque (about 0.7 m/s^2), then the ramp of 10 m/s^2 and its
  // following.
  const double notice_s = 0.011;
  const double acceleration = (0.15 * 0.637 / 7.958e-4 - 36.0) / 85.0;
  const double peak = kSpeed_m_s + 0.005 + acceleration * notice_s;
  const double bound = peak * notice_s + peak * peak / 20.0 + peak * 0.004;
  const double travel = s.truth().table_position_m - s.from.table_position_m;
  EXPECT_GT(travel, kSpeed_m_s * 0.009);
  EXPECT_LT(travel, bound);
}

TEST(SilentMaster, HeartbeatLossStopsTheAxisSteppedBySync) {
  Silence s(Watch::kHeartbeat, EmulatedClock::kSync);
  ExpectStopsByItself(s, 0x8130);
}
TEST(SilentMaster, HeartbeatLossStopsTheAxisOnTheWallClock) {
  Silence s(Watch::kHeartbeat, EmulatedClock::kWall);
  ExpectStopsByItself(s, 0x8130);
}
TEST(SilentMaster, RpdoTimeoutStopsTheAxisSteppedBySync) {
  Silence s(Watch::kRpdo, EmulatedClock::kSync);
  ExpectStopsByItself(s, 0x8250);
}
TEST(SilentMaster, RpdoTimeoutStopsTheAxisOnTheWallClock) {
  Silence s(Watch::kRpdo, EmulatedClock::kWall);
  ExpectStopsByItself(s, 0x8250);
}

TEST(SilentMaster, WithoutAWatchdogTheLastTorqueStays) {
  Silence s(Watch::kHeartbeat, EmulatedClock::kWall, 0);  // 0x6007 = 0: no action
  s.h.RunTimers(100'000'000);
  EXPECT_EQ(s.truth().drive_state, DriveState::kOperationEnabled);
  EXPECT_GT(s.truth().table_position_m, s.from.table_position_m + 5e-3);
}

TEST(SilentMaster, FaultInsteadOfQuickStopWhenAskedFor) {
  Silence s(Watch::kHeartbeat, EmulatedClock::kSync, 1);
  s.h.RunTimers(1'500'000'000);
  EXPECT_EQ(s.truth().drive_state, DriveState::kFault);
}

TEST(SilentMaster, SteppedBySyncTimeStandsStillForTwoTenthsOfASecond) {
  Silence s(Watch::kHeartbeat, EmulatedClock::kSync);
  s.h.RunTimers(190'000'000);  // a slow host, not a dead master
  EXPECT_EQ(s.h.machine.truth().time_s, s.began_s);
  EXPECT_EQ(s.truth().drive_state, DriveState::kOperationEnabled);
  for (int k = 0; k < 20; ++k) s.Cycle();
  EXPECT_EQ(s.truth().drive_state, DriveState::kOperationEnabled);
  EXPECT_TRUE(s.h.Emergencies(1).empty());
}

TEST(SilentMaster, ASlowHostChangesNothing) {
  // The same cycles with and without pauses of the master: the same truth, bit for bit.
  Silence quick(Watch::kHeartbeat, EmulatedClock::kSync);
  Silence slow(Watch::kHeartbeat, EmulatedClock::kSync);
  for (int k = 0; k < 100; ++k) {
    for (Silence* s : {&quick, &slow}) {
      s->h.Heartbeat();
      s->h.Cycle(0x0F, 100 + k);
    }
    slow.h.RunTimers(k % 7 * 20'000'000);
  }
  EXPECT_EQ(quick.truth().table_position_m, slow.truth().table_position_m);
  EXPECT_EQ(quick.truth().friction_N, slow.truth().friction_N);
}

TEST(SilentMaster, WorksAgainAfterTheMasterIsBack) {
  Silence s(Watch::kHeartbeat, EmulatedClock::kSync);
  s.h.RunTimers(1'500'000'000);
  const double rested_s = s.h.machine.truth().time_s;
  s.h.RunTimers(1'000'000'000);  // at rest, time stands still again
  EXPECT_EQ(s.h.machine.truth().time_s, rested_s);
  s.h.Nmt(0x82);
  s.h.RunTimers(5'000'000);
  s.h.BringUp();
  s.h.Enable();
  EXPECT_EQ(s.h.status(1) & 0x6F, 0x27);
}

}  // namespace
}  // namespace contour::test
