// The emulated CiA 402 drive as a master meets it on the bus: SDO, PDO rules, NMT, state machine,
// emergencies.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/plant_emulator/drive_harness.h"
#include "tests/support/drive_faults.h"

namespace contour::test {
namespace {

constexpr std::uint32_t kNoObject = 0x06020000;
constexpr std::uint32_t kNoSubIndex = 0x06090011;
constexpr std::uint32_t kReadOnly = 0x06010002;
constexpr std::uint32_t kLength = 0x06070010;
constexpr std::uint32_t kInvalidValue = 0x06090030;
constexpr std::uint32_t kTooHigh = 0x06090031;
constexpr std::uint32_t kNotMappable = 0x06040041;
constexpr std::uint32_t kPdoTooLong = 0x06040042;
constexpr std::uint32_t kDeviceState = 0x08000022;

class EmulatedDrive : public ::testing::Test {
 protected:
  DriveHarness h{NominalMachine(), {Place("x", 1)}};

  void Cycles(int n, std::uint16_t controlword, std::int32_t target = 0) {
    for (int i = 0; i < n; ++i) h.Cycle(controlword, target);
  }
  const AxisTruth& truth() { return h.machine.truth().axes[0]; }
};

TEST_F(EmulatedDrive, BootsAndSaysWhoItIs) {
  EXPECT_EQ(h.Count(0x701), 1);
  EXPECT_EQ(h.Last(0x701)->data[0], 0);
  EXPECT_EQ(h.Read(1, 0x1000).value, 0x00020192U);
  EXPECT_EQ(h.Read(1, 0x1018, 1).value, 0xC0DU);
  EXPECT_EQ(h.Read(1, 0x1018, 2).value, 0x402U);
  EXPECT_EQ(h.Read(1, 0x6076).value, 637U);
  EXPECT_EQ(h.Read(1, 0x608F, 1).value, 1048576U);
  EXPECT_EQ(h.Read(1, 0x6502).value, 0x280U);
}

TEST_F(EmulatedDrive, AbortsWithTheRightCodes) {
  EXPECT_EQ(h.Read(1, 0x5000).abort, kNoObject);
  EXPECT_EQ(h.Read(1, 0x1018, 9).abort, kNoSubIndex);
  EXPECT_EQ(h.Write(1, 0x1018, 1, 4, 7).abort, kReadOnly);
  EXPECT_EQ(h.Write(1, 0x6060, 0, 2, 10).abort, kLength);
  EXPECT_EQ(h.Write(1, 0x6060, 0, 1, 3).abort, kInvalidValue);  // profile velocity: not this drive
  EXPECT_EQ(h.Write(1, 0x6072, 0, 2, 30000).abort, kTooHigh);
  EXPECT_EQ(h.Write(1, 0x605A, 0, 2, 4).abort, kInvalidValue);
  EXPECT_EQ(h.Write(1, 0x607E, 0, 1, 0x80).abort, kTooHigh);
  EXPECT_FALSE(h.Read(2, 0x1000).answered);  // another node
}

TEST_F(EmulatedDrive, UploadsItsNameInSegments) {
  CanFrame request;
  request.id = 0x601;
  request.length = 8;
  request.data = {0x40, 0x08, 0x10, 0x00};
  h.Send(request);
  ASSERT_EQ(h.Last(0x581)->data[0], 0x41);
  const std::size_t size = h.Last(0x581)->data[4];
  std::string name;
  for (std::uint8_t toggle = 0; name.size() < size; toggle ^= 0x10) {
    request.data = {static_cast<std::uint8_t>(0x60 | toggle)};
    h.Send(request);
    const CanFrame& reply = *h.Last(0x581);
    ASSERT_EQ(reply.data[0] & 0xF0, toggle);
    const std::size_t n = 7U - (reply.data[0] >> 1U & 7U);
    for (std::size_t i = 0; i < n; ++i) name.push_back(static_cast<char>(reply.data[1 + i]));
    ASSERT_EQ((reply.data[0] & 1U) != 0, name.size() == size);
  }
  EXPECT_EQ(name, "contour emulated drive");
  request.data = {0x60};
  h.Send(request);  // nothing under way any more
  EXPECT_EQ(h.Last(0x581)->data[0], 0x80);
}

TEST_F(EmulatedDrive, PdosAreChangedInTheRightOrderOnly) {
  // Mapping while the PDO is valid, or while entries are in force.
  EXPECT_EQ(h.Write(1, 0x1600, 0, 1, 0).abort, kDeviceState);
  h.Expect(1, 0x1400, 1, 4, 0x80000201);
  EXPECT_EQ(h.Write(1, 0x1600, 1, 4, 0x60710010).abort, kDeviceState);
  h.Expect(1, 0x1600, 0, 1, 0);
  EXPECT_EQ(h.Write(1, 0x1600, 1, 4, 0x60410010).abort, kNotMappable);  // statusword into an RPDO
  EXPECT_EQ(h.Write(1, 0x1600, 1, 4, 0x60710020).abort, kNotMappable);  // wrong length
  EXPECT_EQ(h.Write(1, 0x1600, 1, 4, 0x50000010).abort, kNotMappable);
  h.Expect(1, 0x1600, 1, 4, 0x607A0020);
  h.Expect(1, 0x1600, 2, 4, 0x60B10020);
  h.Expect(1, 0x1600, 3, 4, 0x60710010);
  EXPECT_EQ(h.Write(1, 0x1600, 0, 1, 3).abort, kPdoTooLong);
  h.Expect(1, 0x1600, 0, 1, 2);
  EXPECT_EQ(h.Write(1, 0x1400, 2, 1, 250).abort, kInvalidValue);
  EXPECT_EQ(h.Write(1, 0x1400, 1, 4, 0x80).abort, kInvalidValue);  // SYNC's identifier
  h.Expect(1, 0x1400, 1, 4, 0x201);
  EXPECT_EQ(h.Write(1, 0x1400, 1, 4, 0x301).abort, kInvalidValue);  // change of identifier while valid
  EXPECT_EQ(h.Read(1, 0x1400, 1).value, 0x201U);
  // Nothing of it while Operational.
  h.Nmt(0x01);
  EXPECT_EQ(h.Write(1, 0x1400, 1, 4, 0x80000201).abort, kDeviceState);
  // Reset communication brings the defaults back.
  h.Nmt(0x82);
  h.RunTimers(5'000'000);
  EXPECT_EQ(h.Count(0x701), 2);
  EXPECT_EQ(h.Read(1, 0x1600, 0).value, 1U);
}

TEST_F(EmulatedDrive, SynchronousPdosActAtTheSync) {
  h.BringUp();
  h.Command(1, 0x06, 0);
  EXPECT_EQ(h.Read(1, 0x6040).value, 0U);  // waits for SYNC
  h.Sync();
  EXPECT_EQ(h.Read(1, 0x6040).value, 6U);
  EXPECT_EQ(h.Count(0x181), 1);
  // Transmission type 3: every third SYNC.
  h.Nmt(0x80);
  h.Expect(1, 0x1800, 2, 1, 3);
  h.Nmt(0x01);
  h.seen.clear();
  for (int i = 0; i < 9; ++i) h.Sync();
  EXPECT_EQ(h.Count(0x181), 3);
}

TEST_F(EmulatedDrive, EventDrivenRpdoActsAtOnce) {
  h.MapTorquePdos(1);
  h.Expect(1, 0x1400, 2, 1, 255);
  h.Nmt(0x01);
  h.Command(1, 0x06, 0);
  EXPECT_EQ(h.Read(1, 0x6041).value & 0x6FU, 0x21U);
}

TEST_F(EmulatedDrive, NmtDecidesWhatIsServed) {
  h.Expect(1, 0x1017, 0, 2, 10);
  h.RunTimers(1'000'000);
  EXPECT_EQ(h.Last(0x701)->data[0], 127);
  h.Nmt(0x02, 1);
  h.RunTimers(12'000'000);
  EXPECT_EQ(h.Last(0x701)->data[0], 4);
  EXPECT_FALSE(h.Read(1, 0x1000).answered);  // stopped: no SDO
  h.Nmt(0x01, 9);                            // not addressed
  EXPECT_FALSE(h.Read(1, 0x1000).answered);
  h.Nmt(0x80, 1);
  EXPECT_TRUE(h.Read(1, 0x1000).answered);
  h.Nmt(0x01, 1);
  h.seen.clear();
  h.RunTimers(100'000'000);
  EXPECT_EQ(h.Last(0x701)->data[0], 5);
  EXPECT_NEAR(h.Count(0x701), 10, 1);
}

TEST_F(EmulatedDrive, WalksTheStateMachineOneTransitionAtATime) {
  h.BringUp();
  Cycles(2, 0x00);
  EXPECT_EQ(h.status(1) & 0x4F, 0x40);
  Cycles(2, 0x0F);  // enable without shutdown first: nothing
  EXPECT_EQ(h.status(1) & 0x4F, 0x40);
  Cycles(2, 0x06);
  EXPECT_EQ(h.status(1) & 0x6F, 0x21);
  Cycles(2, 0x07);
  EXPECT_EQ(h.status(1) & 0x6F, 0x23);
  Cycles(2, 0x0F);
  EXPECT_EQ(h.status(1) & 0x6F, 0x27);
  EXPECT_NE(h.status(1) & 0x1000, 0);  // follows the target
  Cycles(50, 0x07);                    // disable operation: ramp, let go, then Switched On
  EXPECT_EQ(h.status(1) & 0x6F, 0x23);
  EXPECT_EQ(h.status(1) & 0x1000, 0);
  Cycles(2, 0x06);
  EXPECT_EQ(h.status(1) & 0x6F, 0x21);
  Cycles(2, 0x07);
  Cycles(2, 0x0F);
  Cycles(2, 0x06);  // shutdown from Operation Enabled, 0x605B = 0: at once
  EXPECT_EQ(h.status(1) & 0x6F, 0x21);
  Cycles(2, 0x00);
  EXPECT_EQ(h.status(1) & 0x4F, 0x40);
}

TEST_F(EmulatedDrive, NoTorqueUnlessOperationIsEnabled) {
  h.BringUp();
  Cycles(5, 0x06, 500);
  Cycles(5, 0x07, 500);
  EXPECT_EQ(truth().torque_Nm, 0.0);
  Cycles(5, 0x0F, 500);
  EXPECT_NEAR(truth().torque_Nm, 0.5 * 0.637, 1e-9);
  Cycles(1, 0x0D, 500);  // disable voltage
  EXPECT_EQ(truth().command_Nm, 0.0);
  Cycles(5, 0x0D, 500);
  EXPECT_NEAR(truth().torque_Nm, 0.0, 1e-8);
}

TEST_F(EmulatedDrive, TorqueIsQuantisedOffsetAndLimited) {
  h.BringUp();
  h.Expect(1, 0x60B2, 0, 2, 7);
  h.Expect(1, 0x60E0, 0, 2, 100);
  h.Enable();
  Cycles(1, 0x0F, 50);
  EXPECT_DOUBLE_EQ(truth().command_Nm, 0.057 * 0.637);
  Cycles(1, 0x0F, 200);
  EXPECT_DOUBLE_EQ(truth().command_Nm, 0.100 * 0.637);
  Cycles(1, 0x0F, 200);
  EXPECT_NE(h.status(1) & 0x0800, 0);  // internal limit
  Cycles(1, 0x0F, -200);
  EXPECT_DOUBLE_EQ(truth().command_Nm, -0.193 * 0.637);
}

TEST_F(EmulatedDrive, CurrentLoopLagsByItsTimeConstant) {
  h.BringUp();
  h.Enable();
  Cycles(3, 0x0F, 0);
  Cycles(1, 0x0F, 100);  // acts from this SYNC
  EXPECT_EQ(truth().torque_Nm, 0.0);
  Cycles(1, 0x0F, 100);
  EXPECT_NEAR(truth().torque_Nm, 0.0637 * (1.0 - std::exp(-5.0)), 1e-12);
}

TEST_F(EmulatedDrive, DelayCyclesHoldTheCommandBack) {
  EmulatorConfig config = NominalMachine();
  config.axes["x"].delay_cycles = 3;
  DriveHarness slow(config, {Place("x", 1)});
  slow.BringUp();
  slow.Enable();
  slow.Cycle(0x0F, 100);
  slow.Cycle(0x0F, 0);
  EXPECT_EQ(slow.machine.truth().axes[0].command_Nm, 0.0);
  slow.Cycle(0x0F, 0);
  EXPECT_NEAR(slow.machine.truth().axes[0].command_Nm, 0.0637, 1e-12);
  slow.Cycle(0x0F, 0);
  EXPECT_EQ(slow.machine.truth().axes[0].command_Nm, 0.0);
}

TEST_F(EmulatedDrive, QuickStopBrakesOnItsRampThenLetsGo) {
  h.BringUp();
  h.Expect(1, 0x6085, 0, 4, std::llround(4.0 * 1048576 / 5e-3));  // 4 m/s^2 at the table
  h.Enable();
  for (int k = 0; k < 2000 && truth().table_velocity_m_s < 0.1; ++k) h.Cycle(0x0F, 200);
  const double speed = truth().motor_velocity_m_s;
  const double from = truth().motor_position_m;
  ASSERT_GE(speed, 0.099);
  h.Cycle(0x02, 200);
  h.Cycle(0x02, 200);
  EXPECT_EQ(h.status(1) & 0x6F, 0x07);
  int cycles = 2;
  while ((h.status(1) & 0x6F) == 0x07 && cycles < 200) {
    h.Cycle(0x02, 200);
    ++cycles;
  }
  EXPECT_EQ(h.status(1) & 0x4F, 0x40);
  EXPECT_NEAR(truth().motor_position_m - from, speed * speed / 8.0, 0.15 * speed * speed / 8.0);
  EXPECT_LT(cycles, 1e3 * speed / 4.0 + 40);  // the ramp, then letting go gently
  for (int i = 0; i < 300; ++i) h.Cycle(0x02, 200);
  EXPECT_NEAR(truth().table_velocity_m_s, 0.0, 1e-5);
  EXPECT_NEAR(truth().torque_Nm, 0.0, 1e-9);
}

TEST_F(EmulatedDrive, QuickStopOptionSixStaysAndHolds) {
  h.BringUp();
  h.Expect(1, 0x605A, 0, 2, 6);
  h.Enable();
  Cycles(100, 0x0F, 150);
  Cycles(200, 0x02);
  EXPECT_EQ(h.status(1) & 0x6F, 0x07);
  EXPECT_NEAR(truth().table_velocity_m_s, 0.0, 1e-4);
  Cycles(2, 0x00);
  EXPECT_EQ(h.status(1) & 0x4F, 0x40);
}

TEST_F(EmulatedDrive, FaultReactsReportsAndResetsOnARisingEdgeOnly) {
  h.BringUp();
  h.Enable();
  Cycles(50, 0x0F, 150);
  DriveFaults::Inject(h.machine, 0, 0x2310);
  Cycles(1, 0x0F, 150);
  EXPECT_EQ(h.status(1) & 0x4F, 0x0F);
  Cycles(200, 0x8F, 150);  // bit 7 comes while the reaction runs: no edge in Fault
  EXPECT_EQ(h.status(1) & 0x4F, 0x08);
  EXPECT_EQ(h.Emergencies(1).front(), 0x2310);
  EXPECT_EQ(h.Read(1, 0x603F).value, 0x2310U);
  EXPECT_NE(h.Read(1, 0x1001).value, 0U);
  EXPECT_EQ(h.Read(1, 0x1003, 0).value, 1U);
  EXPECT_EQ(h.Read(1, 0x1003, 1).value, 0x2310U);
  Cycles(3, 0x80);
  EXPECT_EQ(h.status(1) & 0x4F, 0x08);
  Cycles(3, 0x00);
  Cycles(3, 0x80);
  EXPECT_EQ(h.status(1) & 0x4F, 0x40);
  EXPECT_EQ(h.Emergencies(1).back(), 0x0000);
  EXPECT_EQ(h.Read(1, 0x1001).value, 0U);
}

TEST_F(EmulatedDrive, EmergenciesKeepTheirInhibitTime) {
  h.Expect(1, 0x1015, 0, 2, 500);  // 50 ms
  h.Nmt(0x01);
  DriveFaults::Inject(h.machine, 0, 0x2310);
  h.Expect(1, 0x6040, 0, 2, 0x00);
  h.Expect(1, 0x6040, 0, 2, 0x80);
  h.RunTimers(20'000'000);
  EXPECT_EQ(h.Emergencies(1).size(), 1U);
  h.RunTimers(60'000'000);
  ASSERT_EQ(h.Emergencies(1).size(), 2U);
  EXPECT_EQ(h.Emergencies(1)[1], 0x0000);
}

TEST_F(EmulatedDrive, ShortRpdoIsReportedAndIgnored) {
  h.BringUp();
  CanFrame f;
  f.id = 0x201;
  f.length = 2;
  f.data = {0x06, 0x00};
  h.Send(f);
  h.Sync();
  EXPECT_EQ(h.Emergencies(1).back(), 0x8210);
  EXPECT_EQ(h.status(1) & 0x4F, 0x40);
}

TEST_F(EmulatedDrive, LeavingOperationalStopsTheAxis) {
  h.BringUp();
  h.Expect(1, 0x6007, 0, 2, 3);
  h.Enable();
  Cycles(100, 0x0F, 150);
  ASSERT_GT(truth().table_velocity_m_s, 0.01);
  h.Nmt(0x80);
  h.RunTimers(2'000'000'000);  // the master goes on to say nothing
  EXPECT_NE(truth().drive_state, DriveState::kOperationEnabled);
  EXPECT_NEAR(truth().table_velocity_m_s, 0.0, 1e-6);
}

TEST_F(EmulatedDrive, PositionCountsWrapAtInt32) {
  EmulatorConfig config = NominalMachine();
  config.axes["x"].encoder_counts_per_rev = 16777216.0;
  config.axes["x"].start_position_mm = 640.0;  // 128 turns are 2^31 counts
  config.axes["x"].start_variation_mm = 0.0;
  config.axes["x"].stroke_mm = 4000.0;
  DriveHarness far(config, {Place("x", 1)});
  EXPECT_EQ(far.Read(1, 0x6064).value >> 16, 0x8000U);
}

TEST_F(EmulatedDrive, LinearScaleSeesTheTable) {
  EmulatedAxisPlacement place = Place("x", 1);
  EXPECT_EQ(h.Read(1, 0x60E4, 1).abort, kNoObject);
  place.scale_counts_per_mm = 1e5;
  DriveHarness with(NominalMachine(), {place});
  with.Sync();
  const auto counts = static_cast<std::int32_t>(with.Read(1, 0x60E4, 1).value);
  EXPECT_NEAR(counts, 1e8 * with.machine.truth().axes[0].table_position_m, 3.0);
}

TEST_F(EmulatedDrive, FollowingErrorInPositionModeIsAFault) {
  DriveHarness p(NominalMachine(), {Place("x", 1)});
  p.BringUp(8);
  p.Expect(1, 0x6065, 0, 4, 1000);
  p.Expect(1, 0x6066, 0, 2, 5);
  p.Enable(4);
  ASSERT_EQ(p.status(1) & 0x6F, 0x27);
  const std::int32_t from = p.position(1);
  for (int k = 0; k < 400; ++k) p.Cycle(0x0F, from + 500000, 4);
  EXPECT_EQ(p.status(1) & 0x4F, 0x08);
  ASSERT_FALSE(p.Emergencies(1).empty());
  EXPECT_EQ(p.Emergencies(1).front(), 0x8611);
}

// --- The drive's own position cascade
// ---------------------------------------------------------------------------------

/// Largest radial error at the encoder on a circle, after the first turn, um.
double CircleAtEncoder_um(double radius_m, double frequency_Hz, double turns) {
  DriveHarness h(NominalMachine(), {Place("x", 1), Place("y", 2)});
  h.BringUp(8);
  for (const std::uint8_t n : {std::uint8_t{1}, std::uint8_t{2}}) h.Expect(n, 0x60C2, 1, 1, 1);
  h.Enable(4);
  const double counts_per_m = 1048576 / 5e-3;
  const std::int32_t from[2] = {h.position(1), h.position(2)};
  double phase = 0.0;
  double worst = 0.0;
  const double two_pi = 6.283185307179586;
  const double ramp_s = std::max(0.3, 0.25 / frequency_Hz);
  for (int k = 0; phase < turns * two_pi; ++k) {
    const double speed = k * 1e-3 < ramp_s ? 0.5 * (1.0 - std::cos(3.14159265 * k * 1e-3 / ramp_s)) : 1.0;
    phase += speed * two_pi * frequency_Hz * 1e-3;
    h.seen.clear();
    h.Command(
        1, 0x0F,
        from[0] + static_cast<std::int32_t>(std::lround(radius_m * (1.0 - std::cos(phase)) * counts_per_m)),
        4);
    h.Command(2, 0x0F,
              from[1] + static_cast<std::int32_t>(std::lround(radius_m * std::sin(phase) * counts_per_m)), 4);
    h.Sync();
    if (phase < two_pi) continue;
    const auto& axes = h.machine.truth().axes;
    const double x = axes[0].motor_position_m - from[0] / counts_per_m - radius_m;
    const double y = axes[1].motor_position_m - from[1] / counts_per_m;
    worst = std::max(worst, std::fabs(std::hypot(x, y) - radius_m));
  }
  return 1e6 * worst;
}

TEST(EmulatedCascade, IsWellTuned) {
  EXPECT_LT(CircleAtEncoder_um(1e-4, 0.125, 1.6), 0.17);
  EXPECT_LT(CircleAtEncoder_um(1e-4, 0.7853981634, 2.5), 1.02);
  EXPECT_LT(CircleAtEncoder_um(1e-2, 0.05 / (6.283185307 * 0.01), 1.6), 4.16);
}

struct Held {
  double moved_counts = 0.0;  ///< motor, peak to peak, while nothing pushes
  double pushed_m = 0.0;      ///< furthest from the target under the force
  double left_m = 0.0;        ///< from the target, at the end
};

/// Two seconds at a target that stands, then two with 60 N on the table.
Held Hold(int rest_window_counts) {
  EmulatorConfig config = NominalMachine();
  EmulatedCascadeConfig& stiff = config.axes["x"].cascade;
  stiff.position_gain_1_s = 892.0;
  stiff.velocity_gain_1_s = 600.0;
  stiff.velocity_integral_1_s = 493.0;
  stiff.velocity_filter_Hz = 1780.0;
  stiff.rest_window_counts = rest_window_counts;
  config.axes["x"].effects.cutting_force.emplace();
  config.axes["x"].effects.cutting_force->force_N = 60.0;
  config.axes["x"].effects.cutting_force->start_s = 2.0;
  DriveHarness h(config, {Place("x", 1)});
  h.BringUp(8);
  h.Enable(4);
  const std::int32_t target = h.position(1);
  const double count_m = 5e-3 / 1048576;
  const auto& axis = h.machine.truth().axes[0];
  Held held;
  double low_m = 1.0, high_m = -1.0;
  // The force begins at 2 s of the machine's time, some of which bring-up and enabling have used.
  for (int k = 0; k < 4000; ++k) {
    h.seen.clear();
    h.Cycle(0x0F, target, 4);
    const double off_m = axis.motor_position_m - target * count_m;
    if (k >= 1000 && k < 1900) {
      low_m = std::min(low_m, off_m);
      high_m = std::max(high_m, off_m);
    }
    if (k >= 1900) held.pushed_m = std::max(held.pushed_m, std::fabs(off_m));
    held.left_m = std::fabs(off_m);
  }
  held.moved_counts = (high_m - low_m) / count_m;
  return held;
}

TEST(EmulatedCascade, GainsOfRestDoNotAnswerToMisreadCountsButToAForce) {
  const Held without = Hold(0), with = Hold(3);
  EXPECT_GT(without.moved_counts, 1.0);
  EXPECT_LT(with.moved_counts, 0.5);
  EXPECT_GT(with.pushed_m, 1e-6);
  EXPECT_LT(with.pushed_m, 1.1 * without.pushed_m);
  EXPECT_LT(with.left_m, 3.5 * 5e-3 / 1048576);
}

}  // namespace
}  // namespace contour::test
