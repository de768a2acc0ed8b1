// Every effect of the catalogue leaves in the emulated machine what its name says, as large as its parameter
// says; those of forces on the table are in force_effects_test.cc.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/plant_emulator/effects_axis.h"

namespace contour::plant {
namespace {

using test::DriveHarness;
using test::NominalMachine;
using test::Place;

TEST(Effects, AsymmetricCoulomb) {
  EmulatedAxisConfig c = Plain();
  c.effects.asymmetric_coulomb = AsymmetricCoulombEffect{0.2};
  const double plus = Sliding_N(c, 0.0, 0.05);
  const double minus = -Sliding_N(c, 0.0, -0.05);
  EXPECT_NEAR((plus - minus) / (0.5 * (plus + minus)), 0.2, 1e-6);
}

TEST(Effects, ConstantTorque) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.constant_torque = ConstantTorqueEffect{0.03};
  EXPECT_NEAR(Push_N(c, 0.0, 0.0, 0.0) * kRadius_m_rad, 0.03, 1e-6);
  EXPECT_NEAR(Push_N(c, 0.0, -0.1, 0.05) * kRadius_m_rad, 0.08, 1e-6);
}

TEST(Effects, Stribeck) {
  EmulatedAxisConfig c = Plain();
  c.effects.stribeck = StribeckEffect{1.5, 4.0};
  EXPECT_NEAR(Sliding_N(c, 0.0, 0.1), 40.0, 0.01);
  EXPECT_NEAR(Sliding_N(c, 0.0, 4.0 * kRadius_m_rad), 40.0 + 20.0 * std::exp(-1.0), 0.01);
}

TEST(Effects, PositionFriction) {
  EmulatedAxisConfig c = Plain();
  c.effects.position_friction = PositionFrictionEffect{0.3, 1.0, 0.0};
  EXPECT_NEAR(Sliding_N(c, 0.1, 0.05), 52.0, 0.01);
  EXPECT_NEAR(Sliding_N(c, -0.1, -0.05), -28.0, 0.01);
}

TEST(Effects, FrictionMap) {
  EmulatedAxisConfig c = Plain();
  c.effects.friction_map = FrictionMapEffect{{-50, 50, 150}, {-0.1, 0.1, 0.4}};
  EXPECT_NEAR(Sliding_N(c, 0.1, 0.05), 50.0, 0.05);
  EXPECT_NEAR(Sliding_N(c, 0.0, -0.05), -40.0, 0.05);
}

TEST(Effects, CableSpringPullsBackInBothDirectionsOfMotion) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.cable_spring = CableSpringEffect{0.04, 0.0};
  EXPECT_NEAR(Push_N(c, 0.2, 0.01, 0.0) * kRadius_m_rad, -0.04, 1e-6);
  EXPECT_NEAR(Push_N(c, 0.1, -0.01, 0.0) * kRadius_m_rad, -0.02, 1e-6);
  EXPECT_NEAR(Push_N(c, 0.0, 0.0, 0.0), 0.0, 1e-6);
}

TEST(Effects, FrictionRippleFlipsWithDirection) {
  EmulatedAxisConfig c = Plain();
  c.effects.friction_ripple = RippleEffect{{0.1, 2.0, 0.0}, {}};
  EXPECT_NEAR(Sliding_N(c, kTurn_m / 8.0, 0.05), 44.0, 0.01);
  EXPECT_NEAR(Sliding_N(c, kTurn_m / 8.0, -0.05), -44.0, 0.01);
  EXPECT_NEAR(Sliding_N(c, 3.0 * kTurn_m / 8.0, 0.05), 36.0, 0.01);
}

TEST(Effects, BallRippleIsNotPeriodicInTheTurn) {
  EmulatedAxisConfig c = Plain();
  c.effects.ball_ripple = RippleEffect{{0.1, 0.43, 0.0}, {}};
  const double angle = 2.0 * std::numbers::pi * 10.0;
  EXPECT_NEAR(Sliding_N(c, 10.0 * kTurn_m, 0.05), 40.0 * (1.0 + 0.1 * std::sin(0.43 * angle)), 0.01);
}

TEST(Effects, CoggingDoesNotFlipWithDirection) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.cogging = CoggingEffect{{0.01, 12.0, 0.0}, {}};
  for (const double v : {0.05, -0.05})
    EXPECT_NEAR(Push_N(c, kTurn_m / 48.0, v, 0.0) * kRadius_m_rad, 0.01, 1e-5);
}

TEST(Effects, FurtherWavesAddUp) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.cogging = CoggingEffect{{0.01, 12.0, 0.0}, {{0.004, 36.0, 0.0}, {0.002, 24.0, 0.5}}};
  EXPECT_NEAR(Push_N(c, kTurn_m / 48.0, 0.05, 0.0) * kRadius_m_rad, 0.01 - 0.004 - 0.002 * std::sin(0.5),
              1e-5);
}

TEST(Effects, TorqueRippleScalesWithTorque) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.torque_ripple = TorqueRippleEffect{0.05, 6.0, 0.0};
  EXPECT_NEAR(Push_N(c, kTurn_m / 24.0, 0.0, 0.0), 0.0, 1e-6);
  EXPECT_NEAR(Push_N(c, kTurn_m / 24.0, 0.0, 0.2) * kRadius_m_rad, 0.21, 1e-6);
  EXPECT_NEAR(Push_N(c, kTurn_m / 24.0, 0.0, -0.4) * kRadius_m_rad, -0.42, 1e-6);
}

TEST(Effects, ViscousNonlinear) {
  EmulatedAxisConfig c = Plain();
  c.effects.viscous_nonlinear = ViscousNonlinearEffect{{0.05, 300.0, 2.0}, {}};
  EXPECT_NEAR(Sliding_N(c, 0.0, 300.0 * kRadius_m_rad), 40.0 + 0.05 / kRadius_m_rad, 0.02);
  EXPECT_NEAR(Sliding_N(c, 0.0, -150.0 * kRadius_m_rad), -40.0 - 0.0125 / kRadius_m_rad, 0.02);
}

TEST(Effects, ViscousNonlinearWithAKneeAndFurtherCurves) {
  EmulatedAxisConfig c = Plain();
  c.effects.viscous_nonlinear = ViscousNonlinearEffect{{0.05, 300.0, 2.0, 30.0}, {{0.01, 300.0, 2.0, 0.0}}};
  // y (1 + k) / (y + k) with k = 0.1, at y = 1 and y = 0.1.
  EXPECT_NEAR(Sliding_N(c, 0.0, 300.0 * kRadius_m_rad), 40.0 + 0.06 / kRadius_m_rad, 0.02);
  EXPECT_NEAR(Sliding_N(c, 0.0, -30.0 * kRadius_m_rad), -40.0 - (0.05 * 0.55 + 0.01 * 0.01) / kRadius_m_rad,
              0.02);
}

TEST(Effects, AsymmetricViscous) {
  EmulatedAxisConfig c = Plain();
  c.friction.sigma2_Ns_m = 500.0;
  c.effects.asymmetric_viscous = AsymmetricViscousEffect{0.4};
  EXPECT_NEAR(Sliding_N(c, 0.0, 0.05), 40.0 + 500.0 * 1.2 * 0.05, 0.02);
  EXPECT_NEAR(Sliding_N(c, 0.0, -0.05), -40.0 - 500.0 * 0.8 * 0.05, 0.02);
  EXPECT_NEAR(Sliding_N(c, 0.0, 0.1) - Sliding_N(c, 0.0, 0.05), 500.0 * 1.2 * 0.05, 0.02);
}

TEST(Effects, TemperatureViscosity) {
  EmulatedAxisConfig c = Plain();
  c.friction.sigma2_Ns_m = 500.0;
  c.temperature.start_degC = c.temperature.ambient_degC = 30.0;
  c.effects.temperature_viscosity = TemperatureViscosityEffect{-0.02};
  EXPECT_NEAR(Sliding_N(c, 0.0, 0.1), 40.0 + 0.8 * 50.0, 0.01);
}

TEST(Effects, ScrewWarmsUpWithFrictionAndCoolsDown) {
  EmulatedAxisConfig c = Plain();
  c.temperature.rise_K_W = 2.0;
  c.temperature.time_constant_s = 0.5;
  AxisPlant plant = Make(c);
  for (int i = 0; i < 40000; ++i) {
    plant.SetState(0.0, 0.1, 0.0, 0.1);
    plant.Step(5e-5, 0.0);
  }
  EXPECT_NEAR(plant.temperature_degC(), 20.0 + 2.0 * 40.0 * 0.1 * (1.0 - std::exp(-4.0)), 0.1);
  for (int i = 0; i < 40000; ++i) {
    plant.SetState(0.0, 0.0, 0.0, 0.0);
    plant.Step(5e-5, 0.0);
  }
  EXPECT_LT(plant.temperature_degC(), 20.3);
}

TEST(Effects, FrictionDrift) {
  EmulatedAxisConfig c = Plain();
  c.effects.friction_drift = FrictionDriftEffect{0.6, 0.4, 0.0};
  EXPECT_NEAR(Sliding_N(c, 0.0, 0.05), 40.0 * (1.0 + 0.6 * 0.5), 0.1);  // 0.2 s of 0.4 s
  c.effects.friction_drift = FrictionDriftEffect{-0.4, 1.0, 0.1};
  EXPECT_NEAR(Sliding_N(c, 0.0, 0.05), 40.0 * (1.0 - 0.4 * (1.0 - std::exp(-2.0))), 0.1);
}

TEST(Effects, TorqueConstant) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.torque_constant = TorqueConstantEffect{0.85};
  EXPECT_NEAR(Push_N(c, 0.0, 0.0, 0.2) * kRadius_m_rad, 0.17, 1e-6);
}

TEST(Effects, TorqueSaturation) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.torque_saturation = TorqueSaturationEffect{0.1};
  EXPECT_NEAR(Push_N(c, 0.0, 0.0, 0.637) * kRadius_m_rad, 0.9 * 0.637, 1e-5);
  EXPECT_NEAR(Push_N(c, 0.0, 0.0, -0.3185) * kRadius_m_rad, -0.975 * 0.3185, 1e-5);
  // Never less torque for more current.
  EXPECT_GE(Push_N(c, 0.0, 0.0, 1.9), Push_N(c, 0.0, 0.0, 1.2) - 1e-6);
}

TEST(Effects, Compliance) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.compliance = ComplianceEffect{150.0, 0.05};
  AxisPlant plant = Make(c);
  plant.SetState(1e-6, 0.0, 0.0, 0.0);
  plant.Step(1e-7, 0.0);
  const double omega = 2.0 * std::numbers::pi * 150.0;
  EXPECT_NEAR(plant.table_velocity_m_s() / 1e-7, omega * omega * 1e-6, 1e-3 * omega * omega * 1e-6);
}

TEST(Effects, BacklashCarriesNoForceInsideTheGap) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.backlash = BacklashEffect{8.0};
  const auto table_force_N = [&](double windup_m) {
    AxisPlant plant = Make(c);
    plant.SetState(windup_m, 0.0, 0.0, 0.0);
    plant.Step(1e-7, 0.0);
    return c.table_mass_kg * plant.table_velocity_m_s() / 1e-7;
  };
  EXPECT_NEAR(table_force_N(3.9e-6), 0.0, 1e-9);
  EXPECT_NEAR(table_force_N(-3.9e-6), 0.0, 1e-9);
  EXPECT_NEAR(table_force_N(5e-6), 40.0, 0.1);
  EXPECT_NEAR(table_force_N(-6e-6), -80.0, 0.1);
}

TEST(Effects, BacklashShowsAsLostMotion) {
  EmulatedAxisConfig c = Plain(20.0);
  c.effects.backlash = BacklashEffect{8.0};
  AxisPlant plant = Make(c);
  const auto offset_m = [&](double torque) {
    for (int i = 0; i < 6000; ++i) plant.Step(5e-5, torque);
    return plant.motor_position_m() - plant.table_position_m();
  };
  const double forward = offset_m(0.04);
  const double backward = offset_m(-0.05);
  EXPECT_NEAR(forward - backward, 8e-6 + 2.0 * 25.0 / 40e6, 1e-6);
}

TEST(Effects, PreslidingHysteresis) {
  EmulatedAxisConfig c = Plain();
  c.effects.presliding_hysteresis = PreslidingHysteresisEffect{0.3, 0.1};
  EXPECT_NEAR(Sliding_N(c, 0.0, 0.05), 40.0, 0.01);  // the same when sliding
  AxisPlant plant = Make(Heavy(c));
  for (int i = 0; i < 200; ++i) {  // 0.1 um
    plant.SetState(0.0, 1e-5, 0.0, 1e-5);
    plant.Step(5e-5, 0.0);
  }
  EXPECT_NEAR(plant.friction_N(), 5e6 * 1e-7 * (0.7 + 0.3 * 0.1), 0.01);
}

/// Torque of the current loop one period after a step of 100 per mille.
double AfterOnePeriod(const EffectsConfig& effects) {
  EmulatorConfig c = NominalMachine();
  c.axes["x"].effects = effects;
  DriveHarness h(c, {Place("x", 1)});
  h.BringUp();
  h.Enable();
  for (int i = 0; i < 3; ++i) h.Cycle(0x0F, 0);
  h.Cycle(0x0F, 100);
  h.Cycle(0x0F, 100);
  return h.machine.truth().axes[0].torque_Nm / 0.0637;
}

TEST(Effects, InputDelay) {
  EffectsConfig e;
  e.input_delay = InputDelayEffect{310.0};
  EXPECT_NEAR(AfterOnePeriod(e), 1.0 - std::exp(-0.69 / 0.2), 1e-9);
}

TEST(Effects, CurrentLag) {
  EffectsConfig e;
  e.current_lag = CurrentLagEffect{150.0};
  EXPECT_NEAR(AfterOnePeriod(e), 1.0 - std::exp(-1.0 / 0.35), 1e-9);
}

/// Root mean square of encoder minus motor in rad while moving.
double EncoderError_rad(const EffectsConfig& effects, double* correlation = nullptr) {
  EmulatorConfig c = NominalMachine();
  c.axes["x"].effects = effects;
  c.axes["x"].encoder_noise_lsb = 0.0;
  DriveHarness h(c, {Place("x", 1)});
  h.BringUp();
  h.Enable();
  double squares = 0.0;
  double with_speed = 0.0;
  constexpr int kCycles = 1500;
  for (int k = 0; k < kCycles; ++k) {
    h.Cycle(0x0F, 130);
    const AxisTruth& a = h.machine.truth().axes[0];
    const double e = a.reported_position_rad - a.motor_position_m / kRadius_m_rad;
    squares += e * e;
    const double w = a.motor_velocity_m_s / kRadius_m_rad;
    with_speed += w * w;
  }
  if (correlation != nullptr) *correlation = std::sqrt(with_speed / kCycles);
  return std::sqrt(squares / kCycles);
}

TEST(Effects, EncoderErrors) {
  const double lsb = 2.0 * std::numbers::pi / 1048576;
  EXPECT_NEAR(EncoderError_rad({}), lsb / std::sqrt(12.0), 0.2 * lsb);
  EffectsConfig e;
  e.encoder_eccentricity = EncoderEccentricityEffect{1e-3, 0.4};
  EXPECT_NEAR(EncoderError_rad(e), 1e-3 / std::sqrt(2.0), 0.6e-4);
  e = {};
  e.encoder_subdivision = EncoderSubdivisionEffect{2e-4, 512.0, 0.0};
  EXPECT_NEAR(EncoderError_rad(e), 2e-4 / std::sqrt(2.0), 1e-5);
}

TEST(Effects, SampleJitterGrowsWithSpeed) {
  EffectsConfig e;
  e.sample_jitter = SampleJitterEffect{20.0};
  double speed_rad_s = 0.0;
  const double error = EncoderError_rad(e, &speed_rad_s);
  EXPECT_NEAR(error, 20e-6 * speed_rad_s, 0.1 * 20e-6 * speed_rad_s);
}

TEST(Effects, PitchErrorStandsInTheTableOnly) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.pitch_error = PitchErrorEffect{12.0, 1.0, 0.0};
  AxisPlant plant = Make(c);
  plant.SetState(0.1, 0.0, 0.1, 0.0);
  EXPECT_NEAR(plant.table_position_m(), 0.1 + 12e-6, 1e-12);
  EXPECT_EQ(plant.motor_position_m(), 0.1);
  EXPECT_NEAR(Push_N(c, 0.1, 0.0, 0.0), 0.0, 1e-9);
}

TEST(Effects, PitchMapIsTheSameByATable) {
  EmulatedAxisConfig c = Plain(0.0);
  c.effects.pitch_map = PitchMapEffect{{0.0, 80.0, 120.0}, {0.0, 4.0, 8.0}};
  AxisPlant plant = Make(c);
  plant.SetState(0.1, 0.0, 0.1, 0.0);
  EXPECT_NEAR(plant.table_position_m(), 0.1 + 6e-6, 1e-12);
  plant.SetState(0.15, 0.0, 0.15, 0.0);
  EXPECT_NEAR(plant.table_position_m(), 0.15 + 8e-6, 1e-12);
}

}  // namespace
}  // namespace contour::plant
