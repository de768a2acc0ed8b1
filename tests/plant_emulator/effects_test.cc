// Every effect of the catalogue leaves in the emulated machine what its name says, as large as its parameter
// says.
#include "tools/plant_emulator/effects_config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/plant_emulator/drive_harness.h"
#include "tools/plant_emulator/axis_plant.h"

namespace contour::plant {
namespace {

using test::DriveHarness;
using test::NominalAxis;
using test::NominalMachine;
using test::Place;

constexpr double kRadius_m_rad = 5e-3 / (2.0 * std::numbers::pi);
constexpr double kTurn_m = 5e-3;

/// Constant friction of 40 N in both directions, nothing that varies; or none at all.
EmulatedAxisConfig Plain(double friction_N = 40.0) {
  EmulatedAxisConfig c = NominalAxis();
  auto& f = c.friction;
  f.Fs_plus_N = f.Fs_minus_N = f.Fc_plus_N = f.Fc_minus_N = friction_N;
  f.sigma1_Ns_m = 0.0;
  f.sigma2_Ns_m = 0.0;
  f.position_amplitude_rel = f.ripple_amplitude_rel = 0.0;
  c.start_variation_mm = 0.0;
  return c;
}
AxisPlant Make(const EmulatedAxisConfig& c) {
  AxisParameters p = MakeAxisParameters(c, Place("x", 1), 1, 0.0, 0);
  p.start_bristle_N = 0.0;
  return AxisPlant(p);
}

/// Too heavy for friction to slow it within a step.
EmulatedAxisConfig Heavy(EmulatedAxisConfig c) {
  c.table_mass_kg = 1e9;
  c.motor_inertia_kgm2 = 1e3;
  return c;
}

/// Friction in steady sliding at a place and speed.
double Sliding_N(const EmulatedAxisConfig& light, double x_m, double v_m_s) {
  const EmulatedAxisConfig c = Heavy(light);
  AxisPlant plant = Make(c);
  for (int i = 0; i < 4000; ++i) {
    plant.SetState(x_m, v_m_s, x_m, v_m_s);
    plant.Step(5e-5, 0.0);
  }
  plant.SetState(x_m, v_m_s, x_m, v_m_s);
  return plant.friction_N();
}

/// Force on the whole axis without friction: change of momentum over a very short step.
double Push_N(const EmulatedAxisConfig& c, double x_m, double v_m_s, double torque_Nm,
              double windup_m = 0.0) {
  AxisPlant plant = Make(c);
  plant.SetState(x_m + windup_m, v_m_s, x_m, v_m_s);
  const double h = 1e-7;
  plant.Step(h, torque_Nm);
  const double motor_kg = c.motor_inertia_kgm2 / (kRadius_m_rad * kRadius_m_rad);
  return (motor_kg * (plant.motor_velocity_m_s() - v_m_s) +
          c.table_mass_kg * (plant.table_velocity_m_s() - v_m_s)) /
         h;
}

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
