// Forces that act on the table, and effects outside the catalogue.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/plant_emulator/effects_axis.h"

namespace contour::plant {
namespace {

using test::DriveHarness;
using test::NominalMachine;
using test::Place;

TEST(Effects, PayloadStep) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.payload_step = PayloadStepEffect{0.5, 0.1};
  AxisPlant plant = Make(c);
  const auto gain = [&] {
    const double before = plant.motor_velocity_m_s();
    for (int i = 0; i < 2000; ++i) plant.Step(5e-5, 0.05);
    return plant.motor_velocity_m_s() - before;
  };
  const double light = gain();
  const double heavy = gain();
  EXPECT_NEAR(light / heavy, 1.5, 0.01);
}

TEST(Effects, CrossCouplingPushesWhileTheOtherAccelerates) {
  EmulatorConfig c = NominalMachine();
  c.axes["x"] = Plain(0.0);
  c.axes["x"].effects.cross_coupling = CrossCouplingEffect{"y", 2e-3};
  DriveHarness h(c, {Place("x", 1), Place("y", 2)});
  h.BringUp();
  h.Enable();
  const double x_before = h.machine.truth().axes[0].motor_velocity_m_s;
  const double y_before = h.machine.truth().axes[1].motor_velocity_m_s;
  for (int k = 0; k < 100; ++k) {
    h.Command(1, 0x0F, 0);
    h.Command(2, 0x0F, 400);
    h.Sync();
  }
  const double x_gained = h.machine.truth().axes[0].motor_velocity_m_s - x_before;
  const double y_gained = h.machine.truth().axes[1].motor_velocity_m_s - y_before;
  ASSERT_GT(y_gained, 0.1);
  const double mass_kg = 5e-5 / (kRadius_m_rad * kRadius_m_rad) + 10.0;
  EXPECT_NEAR(x_gained, 2e-3 / kRadius_m_rad / mass_kg * y_gained, 0.1 * x_gained);
}

TEST(Effects, LoadFrictionGrowsWithAcceleratingForce) {
  // The same torque both ways through: what friction adds is the stated share of the accelerating force.
  const auto run = [](double share) {
    EmulatedAxisConfig c = Plain();
    c.effects.load_friction = LoadFrictionEffect{share};
    AxisPlant plant = Make(c);
    for (int i = 0; i < 2000; ++i) plant.Step(5e-5, 0.3);
    return plant;
  };
  const AxisPlant with = run(0.1);
  const AxisPlant without = run(0.0);
  const double load = 0.3 / kRadius_m_rad - with.friction_N();
  EXPECT_NEAR(with.friction_N() - without.friction_N(), 0.1 * load, 0.03 * load);
}

TEST(Effects, PeriodicForce) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.periodic_force = PeriodicForceEffect{0.02, 50.0, std::numbers::pi / 2.0};
  EXPECT_NEAR(Push_N(c, 0.0, 0.0, 0.0) * kRadius_m_rad, 0.02, 1e-5);
  AxisPlant plant = Make(c);
  for (int i = 0; i < 400; ++i) plant.Step(5e-5, 0.0);  // one period: no net push
  const double amplitude = 0.02 / kRadius_m_rad / 89.0 / (2.0 * std::numbers::pi * 50.0);
  EXPECT_NEAR(plant.motor_velocity_m_s(), 0.0, 0.1 * amplitude);
}

TEST(OutsideEffects, StickSpotIsAtOnePlaceInOneDirection) {
  EmulatedAxisConfig c = Plain();
  c.effects.outside = OutsideEffectsConfig{};
  c.effects.outside->stick_spot = StickSpotEffect{0.5, 20.0, 3.0, 1};
  EXPECT_NEAR(Sliding_N(c, 0.020, 0.05), 60.0, 0.01);
  EXPECT_NEAR(Sliding_N(c, 0.020, -0.05), -40.0, 0.01);
  EXPECT_NEAR(Sliding_N(c, 0.050, 0.05), 40.0, 0.01);
}

TEST(OutsideEffects, CableDragsBehindTheMotion) {
  EmulatedAxisConfig c = Heavy(Plain(0.0));
  c.effects.outside = OutsideEffectsConfig{};
  c.effects.outside->cable_hysteresis = CableHysteresisEffect{0.02, 10.0};
  OutsideEffects cable(*c.effects.outside, kRadius_m_rad);
  const auto move = [&](double from_mm, double to_mm) {
    for (int i = 0; i <= 1000; ++i)
      cable.Advance(1e-4, 1e-3 * (from_mm + (to_mm - from_mm) * i / 1000.0), 0.0);
    return cable.Force_N(0.0) * kRadius_m_rad;
  };
  EXPECT_NEAR(move(0.0, 100.0), -0.02, 1e-5);
  EXPECT_NEAR(move(100.0, 90.0), 0.02 - 0.04 * std::exp(-1.0), 1e-4) << "remembers where it came from";
  EXPECT_NEAR(move(90.0, 0.0), 0.02, 1e-5);
}

TEST(OutsideEffects, TelegraphLubricationAndSpeedBand) {
  OutsideEffectsConfig c;
  c.telegraph_torque = TelegraphTorqueEffect{0.01, 0.1};
  OutsideEffects telegraph(c, kRadius_m_rad);
  int jumps = 0;
  double last = telegraph.Force_N(0.0);
  for (int i = 0; i < 100000; ++i) {  // 10 s
    telegraph.Advance(1e-4, 0.0, 0.0);
    EXPECT_NEAR(std::abs(telegraph.Force_N(0.0)) * kRadius_m_rad, 0.01, 1e-12);
    jumps += telegraph.Force_N(0.0) != last;
    last = telegraph.Force_N(0.0);
  }
  EXPECT_NEAR(jumps, 100, 35);

  c = {};
  c.lubrication = LubricationEffect{0.4, 50.0};
  OutsideEffects lubricated(c, kRadius_m_rad);
  lubricated.Advance(1e-3, 0.0, 0.0);
  lubricated.Advance(1e-3, 0.025, 0.0);
  EXPECT_NEAR(lubricated.Level(0.0, 0.0), 0.2, 1e-12);
  lubricated.Advance(1e-3, 0.0, 0.0);
  lubricated.Advance(1e-3, 0.001, 0.0);
  EXPECT_NEAR(lubricated.Level(0.0, 0.0), 0.0, 1e-12) << "fresh oil after 51 mm of way";

  c = {};
  c.speed_band_torque = SpeedBandTorqueEffect{0.03, 50.0, 60.0};
  const OutsideEffects band(c, kRadius_m_rad);
  for (const double sign : {1.0, -1.0}) {
    EXPECT_NEAR(band.Force_N(sign * 55.0 * kRadius_m_rad) * kRadius_m_rad, 0.03, 1e-12);
    EXPECT_EQ(band.Force_N(sign * 65.0 * kRadius_m_rad), 0.0);
  }
}

/// Noise on the torque is white, as strong as stated as a mean over a cycle, and changes when it should.
TEST(TorqueNoise, HasTheStatedStrength) {
  EmulatorConfig c = NominalMachine();
  EmulatedAxisConfig& axis = c.axes["x"];
  axis = Heavy(Plain(0.0));
  axis.encoder_noise_lsb = 0.0;
  axis.torque_noise_Nm = 1e3;  // against 1e3 kg m^2
  axis.torque_noise_change = 3.0;
  axis.torque_noise_change_s = 4.0;
  DriveHarness h(c, {Place("x", 1)});
  h.BringUp();
  h.Enable();
  double before = h.machine.truth().axes[0].motor_velocity_m_s;
  double squares[2] = {0.0, 0.0};
  int count[2] = {0, 0};
  for (int k = 0; k < 8000; ++k) {
    h.Cycle(0x0F, 0);
    const double now = h.machine.truth().axes[0].motor_velocity_m_s;
    const double torque = (now - before) / 1e-3 / kRadius_m_rad * 1e3;
    const int half = h.machine.truth().time_s > 4.0 ? 1 : 0;
    squares[half] += torque * torque;
    ++count[half];
    before = now;
  }
  const double first = std::sqrt(squares[0] / count[0]);
  const double second = std::sqrt(squares[1] / count[1]);
  // The screw spreads a kick over both inertias; what matters is the size and its change.
  EXPECT_GT(first, 0.5e3);
  EXPECT_LT(first, 1.5e3);
  EXPECT_NEAR(second / first, 3.0, 0.3);
}

TEST(Effects, CuttingForceActsForItsTimeOnly) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.cutting_force = CuttingForceEffect{-60.0, 0.01, 0.02};
  AxisPlant plant = Make(c);
  for (int i = 0; i < 200; ++i) plant.Step(5e-5, 0.0);
  EXPECT_EQ(plant.motor_velocity_m_s(), 0.0);
  for (int i = 0; i < 400; ++i) plant.Step(5e-5, 0.0);
  const double mass_kg = 5e-5 / (kRadius_m_rad * kRadius_m_rad) + 10.0;
  const double momentum = plant.motor_velocity_m_s() * (mass_kg - 10.0) + plant.table_velocity_m_s() * 10.0;
  EXPECT_NEAR(momentum, -60.0 * 0.01, 0.01);
}

TEST(Effects, CuttingForceComesAgain) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.cutting_force = CuttingForceEffect{-60.0, 0.01, 0.02, 0.03};
  AxisPlant plant = Make(c);
  const double mass_kg = 5e-5 / (kRadius_m_rad * kRadius_m_rad) + 10.0;
  for (int times = 1; times <= 3; ++times) {
    for (int i = 0; i < 600; ++i) plant.Step(5e-5, 0.0);
    const double momentum = plant.motor_velocity_m_s() * (mass_kg - 10.0) + plant.table_velocity_m_s() * 10.0;
    EXPECT_NEAR(momentum, -60.0 * 0.01 * times, 0.01 * times);
  }
}

}  // namespace
}  // namespace contour::plant
