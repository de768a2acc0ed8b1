#include "tools/plant_emulator/emulated_machine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/plant_emulator/drive_harness.h"
#include "tests/support/allocation_guard.h"

namespace contour::test {
namespace {

/// A second of a fixed torque history; what the machine truly did and what its encoders said.
struct History {
  std::vector<double> table_m;
  std::vector<double> friction_N;
  std::vector<double> reported_rad;
  friend bool operator==(const History&, const History&) = default;
};
History Record(const EmulatorConfig& config, int cycles = 1000) {
  DriveHarness h(config, {Place("x", 1), Place("y", 2)});
  h.BringUp();
  h.Enable();
  History history;
  for (int k = 0; k < cycles; ++k) {
    h.Cycle(0x0F, static_cast<std::int32_t>(160.0 * std::sin(0.02 * k)));
    for (const AxisTruth& a : h.machine.truth().axes) {
      history.table_m.push_back(a.table_position_m);
      history.friction_N.push_back(a.friction_N);
      history.reported_rad.push_back(a.reported_position_rad);
    }
  }
  return history;
}

TEST(EmulatedMachine, MovesTheWayTheTorquePushes) {
  DriveHarness h(NominalMachine(), {Place("x", 1), Place("y", 2)});
  h.BringUp();
  h.Enable();
  ASSERT_EQ(h.status(1) & 0x6F, 0x27);
  ASSERT_EQ(h.status(2) & 0x6F, 0x27);
  const AxisTruth before = h.machine.truth().axes[0];
  for (int k = 0; k < 200; ++k) h.Cycle(0x0F, 150);
  const AxisTruth& after = h.machine.truth().axes[0];
  EXPECT_GT(after.table_position_m, before.table_position_m + 1e-3);
  EXPECT_GT(after.friction_N, 0.0);
  EXPECT_NEAR(after.torque_Nm, 0.150 * 0.637, 1e-6);
}

TEST(EmulatedMachine, SyncNumberNFallsOnPlantTimeNPeriods) {
  DriveHarness h(NominalMachine(), {Place("x", 1), Place("y", 2)});
  h.BringUp();
  for (int k = 0; k < 7; ++k) h.Cycle(0x06);
  EXPECT_EQ(h.machine.truth().sync_number, 7U);
  EXPECT_DOUBLE_EQ(h.machine.truth().time_s, 0.007);
}

TEST(EmulatedMachine, AHostThatWasHeldUpIsNoSilentMaster) {
  EmulatorConfig config = NominalMachine();
  DriveHarness h(config, {Place("x", 1), Place("y", 2)});
  h.BringUp();
  h.Enable();
  for (int k = 0; k < 3; ++k) {
    // Nobody ran for ten times silence_ms; then the timer comes first, and a frame after it.
    h.now_ns += static_cast<std::int64_t>(config.silence_ms * 1e7);
    PendingFrames out;
    h.machine.node(0).OnTimer(h.now_ns, out);
    h.Cycle(0x0F);
    EXPECT_FALSE(h.machine.truth().free_running);
  }
  h.RunTimers(static_cast<std::int64_t>(config.silence_ms * 1e6) - 2'000'000);
  EXPECT_FALSE(h.machine.truth().free_running);
  h.RunTimers(4'000'000);
  EXPECT_TRUE(h.machine.truth().free_running) << "listened to all along, the master was silent";
}

TEST(EmulatedMachine, SameSeedSameMachineBitForBit) {
  for (const auto law : {EmulatedFrictionLaw::kLugre, EmulatedFrictionLaw::kMaxwellSlip}) {
    EmulatorConfig c = NominalMachine();
    c.axes["x"].friction.law = law;
    EXPECT_EQ(Record(c), Record(c));
  }
}

TEST(EmulatedMachine, AnotherSeedIsAnotherMachine) {
  EmulatorConfig a = NominalMachine();
  EmulatorConfig b = NominalMachine();
  b.seed = 2;
  const History first = Record(a, 300);
  const History second = Record(b, 300);
  EXPECT_NE(first.table_m[0], second.table_m[0]);  // start
  // Parameters, ripple and initial bristle too: after a reversal free motion differs by more than the start
  // does.
  EXPECT_GT(std::fabs((first.table_m[598] - first.table_m[0]) - (second.table_m[598] - second.table_m[0])),
            1e-6);
}

TEST(EmulatedMachine, SeedVariesParametersByAtMostFivePercent) {
  // Free of friction, a constant torque shows the inertia.
  double lowest = 1e9;
  double highest = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EmulatorConfig c = NominalMachine();
    c.seed = seed;
    auto& f = c.axes["x"].friction;
    f.Fs_plus_N = f.Fs_minus_N = f.Fc_plus_N = f.Fc_minus_N = f.sigma1_Ns_m = f.sigma2_Ns_m = 0.0;
    DriveHarness h(c, {Place("x", 1)});
    h.BringUp();
    h.Enable();
    const double before = h.machine.truth().axes[0].motor_velocity_m_s;
    for (int k = 0; k < 200; ++k) h.Cycle(0x0F, 100);
    const double gained = h.machine.truth().axes[0].motor_velocity_m_s - before;
    lowest = std::min(lowest, gained);
    highest = std::max(highest, gained);
  }
  const double nominal = 0.0637 / (5e-3 / 6.283185307) / (5e-5 / 6.3326e-7 + 10.0) * (0.2 - 0.0012);
  EXPECT_GT(lowest, nominal / 1.052);
  EXPECT_LT(highest, nominal * 1.055);
  EXPECT_GT(highest - lowest, 0.03 * nominal);
}

TEST(EmulatedMachine, EncoderShowsTheMotorWithinNoiseAndQuantisation) {
  DriveHarness h(NominalMachine(), {Place("x", 1)});
  h.BringUp();
  h.Enable();
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kCycles = 2000;
  for (int k = 0; k < kCycles; ++k) {
    h.Cycle(0x0F, static_cast<std::int32_t>(160.0 * std::sin(0.02 * k)));
    const AxisTruth& a = h.machine.truth().axes[0];
    const double error_counts = (a.reported_position_rad - a.motor_position_m / (5e-3 / 6.283185307179586)) *
                                1048576 / 6.283185307179586;
    sum += error_counts;
    squares += error_counts * error_counts;
  }
  EXPECT_NEAR(sum / kCycles, 0.0, 0.05);
  EXPECT_NEAR(std::sqrt(squares / kCycles), std::sqrt(0.3 * 0.3 + 1.0 / 12.0), 0.03);
}

TEST(EmulatedMachine, TruthSaysWhereAnIncrementalEncoderBeganToCount) {
  EmulatorConfig c = NominalMachine();
  c.axes["x"].incremental_encoder = true;
  c.axes["x"].start_position_mm = 7.0;
  DriveHarness h(c, {Place("x", 1)});
  h.BringUp();
  const AxisTruth& a = h.machine.truth().axes[0];
  EXPECT_NEAR(a.reported_position_rad, 0.0, 1e-4);
  EXPECT_GT(a.encoder_zero_m, 1e-3);
  EXPECT_NEAR(a.motor_position_m - a.encoder_zero_m, 0.0, 1e-7);
}

TEST(EmulatedMachine, FrictionVariesOverTheTurn) {
  const auto spread = [](double ripple) {
    EmulatorConfig c = NominalMachine();
    c.axes["x"].friction.ripple_amplitude_rel = ripple;
    c.axes["x"].friction.position_amplitude_rel = 0.0;
    DriveHarness h(c, {Place("x", 1)});
    h.BringUp();
    h.Enable();
    double low = 1e9;
    double high = 0.0;
    for (int k = 0; k < 1200; ++k) {
      h.Cycle(0x0F, 110);
      if (k < 200) continue;
      const AxisTruth& a = h.machine.truth().axes[0];
      const double level = a.friction_N - 500.0 * a.table_velocity_m_s;
      low = std::min(low, level);
      high = std::max(high, level);
    }
    return (high - low) / (high + low);
  };
  EXPECT_LT(spread(0.0), 0.03);
  EXPECT_NEAR(spread(0.08), 0.08, 0.025);
}

TEST(EmulatedMachine, SteppingTouchesNoHeap) {
  if (!AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  DriveHarness h(NominalMachine(), {Place("x", 1), Place("y", 2)});
  h.BringUp();
  h.Enable();
  CanFrame command;
  command.id = 0x201;
  command.length = 4;
  command.data = {0x0F, 0x00, 100, 0};
  CanFrame sync;
  sync.id = 0x80;
  CanFrame question;
  question.id = 0x601;
  question.length = 8;
  question.data = {0x40, 0x41, 0x60, 0x00};
  PendingFrames out;
  BusNode& node = h.machine.node(0);
  AllocationGuard guard;
  for (int k = 0; k < 100; ++k) {
    out.clear();
    h.now_ns += 1'000'000;
    node.OnFrame(command, h.now_ns, out);
    node.OnFrame(question, h.now_ns, out);
    node.OnFrame(sync, h.now_ns, out);
    if (node.NextTimer() <= h.now_ns) node.OnTimer(h.now_ns, out);
  }
  h.now_ns += 300'000'000;
  node.OnTimer(h.now_ns, out);
  EXPECT_EQ(guard.calls(), 0U);
}

TEST(EmulatedMachine, TwoBusesEachWithTheirOwnSync) {
  DriveHarness h(NominalMachine(), {Place("x", 1, 0), Place("y", 1, 1)});
  ASSERT_EQ(h.machine.bus_count(), 2U);
  CanFrame sync;
  sync.id = 0x80;
  h.Send(sync, 0);
  EXPECT_EQ(h.machine.truth().sync_number, 0U);  // a row belongs to all axes
  h.Send(sync, 1);
  EXPECT_EQ(h.machine.truth().sync_number, 1U);
}

TEST(EmulatedMachine, RefusesWhatItCannotEmulate) {
  const std::vector<EmulatedAxisPlacement> x{Place("x", 1)};
  EXPECT_THROW(EmulatedMachine(NominalMachine(), std::vector{Place("z", 1)}, 1000), std::invalid_argument);
  EXPECT_THROW(EmulatedMachine(NominalMachine(), std::vector{Place("x", 0)}, 1000), std::invalid_argument);
  EXPECT_THROW(EmulatedMachine(NominalMachine(), std::vector{Place("x", 1), Place("y", 1)}, 1000),
               std::invalid_argument);
  EmulatorConfig bad = NominalMachine();
  bad.axes["x"].friction.Fs_plus_N = 1.0;
  EXPECT_THROW(EmulatedMachine(bad, x, 1000), std::invalid_argument);
  EmulatorConfig coupled = NominalMachine();
  coupled.axes["x"].effects.cross_coupling = CrossCouplingEffect{"nowhere", 1e-4};
  EXPECT_THROW(EmulatedMachine(coupled, x, 1000), std::invalid_argument);
}

}  // namespace
}  // namespace contour::test
