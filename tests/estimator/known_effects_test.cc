#include "estimator/known_effects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace contour {
namespace {

const Mechanics kMechanics = ToSi({5.0, 5e-5, 10.0, 40.0, 1100.0});
constexpr double kNoTemperature = std::numeric_limits<double>::quiet_NaN();

TEST(KnownEffectsTest, NothingKnownIsNeutral) {
  const KnownEffects none;
  EXPECT_EQ(none.Force_N(0.1), 0.0);
  EXPECT_EQ(none.LevelFactor(0.1), 1.0);
  EXPECT_EQ(none.Viscous_N(0.1, 30.0), 0.0);
  EXPECT_EQ(none.Lead_m(0.1), 0.0);
}

TEST(KnownEffectsTest, TheMotorMakesUpForAWobbleOfTheLead) {
  ExtensionsConfig c;
  c.lead_wobble = LeadWobbleExtension{{0.3, 1.0, 0.7}, {{0.1, 2.0, -0.2}}};
  const KnownEffects known(c, kMechanics, 500.0);
  EXPECT_FALSE(known.neutral());
  for (const double x : {-0.123, 0.0, 0.0501}) {
    const double angle = x / kMechanics.radius_m_rad;
    EXPECT_NEAR(known.Lead_m(x), -(0.3e-6 * std::sin(angle + 0.7) + 0.1e-6 * std::sin(2.0 * angle - 0.2)),
                1e-12);
  }
}

// A motor's own torque does not go through the screw; what pulls at the table does.
TEST(KnownEffectsTest, ForcesBesideTheCommandsOnMotorAndTable) {
  ExtensionsConfig c;
  c.cogging = CoggingExtension{{0.02, 12.0, 0.7}, {}};
  c.constant_torque = ConstantTorqueExtension{0.01};
  c.cable_spring = CableSpringExtension{0.0, {-100, 100}, {0.05, -0.05}};
  const KnownEffects known(c, kMechanics, 500.0);
  const double r = kMechanics.radius_m_rad;
  for (const double x : {-0.123, 0.0, 0.0501}) {
    const double spring = -0.05 * std::clamp(x / 0.1, -1.0, 1.0);
    const double motors = 0.01 + 0.02 * std::sin(12.0 * x / r + 0.7);
    EXPECT_NEAR(known.MotorForce_N(x) * r, motors, 1e-12) << x;
    EXPECT_NEAR(known.TableForce_N(x) * r, spring, 1e-12) << x;
    EXPECT_NEAR(known.Force_N(x) * r, motors + spring, 1e-12) << x;
  }
  EXPECT_NEAR(known.Constant_N() * r, 0.01, 1e-15);
}

TEST(KnownEffectsTest, SeveralOfOneKindAddUp) {
  ExtensionsConfig c;
  c.cogging = CoggingExtension{{0.02, 12.0, 0.7}, {{0.01, 24.0, 0.1}}};
  c.friction_ripple = RippleExtension{{0.1, 2.0, 0.3}, {{0.05, 3.0, 0.0}, {0.02, 5.0, 1.0}}};
  c.viscous_nonlinear = ViscousNonlinearExtension{{0.03, 300.0, 2.0, 0.0}, {{0.01, 300.0, 1.5, 30.0}}};
  const KnownEffects known(c, kMechanics, 500.0);
  const double r = kMechanics.radius_m_rad;
  for (const double x : {-0.123, 0.0, 0.0501}) {
    const double angle = x / r;
    EXPECT_NEAR(known.Force_N(x) * r,
                0.02 * std::sin(12.0 * angle + 0.7) + 0.01 * std::sin(24.0 * angle + 0.1), 1e-12);
    EXPECT_NEAR(known.LevelFactor(x),
                1.0 + 0.1 * std::sin(2.0 * angle + 0.3) + 0.05 * std::sin(3.0 * angle) +
                    0.02 * std::sin(5.0 * angle + 1.0),
                1e-11);
  }
  EXPECT_NEAR(known.Viscous_N(150.0 * r, kNoTemperature) * r, 0.25 * 0.03 + 0.01 * 0.5 * 1.1 / 0.6, 1e-12);
}

// The model's numbers are in units of the torque that is asked for; so are the forces beside them.
TEST(KnownEffectsTest, ForcesFollowTheTorqueConstant) {
  ExtensionsConfig c;
  c.constant_torque = ConstantTorqueExtension{0.01};
  c.torque_constant = TorqueConstantExtension{0.8};
  const KnownEffects known(c, kMechanics, 500.0);
  EXPECT_NEAR(known.Force_N(0.0) * kMechanics.radius_m_rad, 0.0125, 1e-12);
}

TEST(KnownEffectsTest, FrictionAlongStrokeAndTurn) {
  ExtensionsConfig c;
  c.position_friction = PositionFrictionExtension{0.2, {0, 10, 30}, {0.0, 0.2, -0.1}};
  c.friction_ripple = RippleExtension{{0.1, 2.0, 0.3}, {}};
  const KnownEffects known(c, kMechanics, 500.0);
  const auto ripple = [&](double x) { return 1.0 + 0.1 * std::sin(2.0 * x / kMechanics.radius_m_rad + 0.3); };
  EXPECT_NEAR(known.LevelFactor(-1.0), 1.0 * ripple(-1.0), 1e-12);
  EXPECT_NEAR(known.LevelFactor(0.005), 1.1 * ripple(0.005), 1e-12);
  EXPECT_NEAR(known.LevelFactor(0.020), 1.05 * ripple(0.020), 1e-12);
  EXPECT_NEAR(known.LevelFactor(9.0), 0.9 * ripple(9.0), 1e-11);
}

TEST(KnownEffectsTest, ViscousFrictionOpposesMotionAndFollowsTemperature) {
  ExtensionsConfig c;
  c.viscous_nonlinear = ViscousNonlinearExtension{{0.03, 300.0, 2.0}, {}};
  c.temperature_viscosity = TemperatureViscosityExtension{-0.02, 25.0};
  const KnownEffects known(c, kMechanics, 500.0);
  const double r = kMechanics.radius_m_rad;
  const double half_speed = 150.0 * r;
  EXPECT_NEAR(known.Viscous_N(half_speed, kNoTemperature), 0.25 * 0.03 / r, 1e-9);
  EXPECT_NEAR(known.Viscous_N(-half_speed, kNoTemperature), -0.25 * 0.03 / r, 1e-9);
  EXPECT_NEAR(known.Viscous_N(half_speed, 30.0), 0.25 * 0.03 / r - 500.0 * 0.1 * half_speed, 1e-9);
}

TEST(KnownEffectsTest, TheMotorGoesAgainstThePitchError) {
  ExtensionsConfig c;
  c.pitch_error = PitchErrorExtension{2.0, {-100, 100}, {-2.0, 2.0}};
  EXPECT_NEAR(KnownEffects(c, kMechanics, 0.0).Lead_m(0.05), -1e-6, 1e-15);
}

TEST(KnownEffectsTest, RefusesTablesThatAreNone) {
  ExtensionsConfig c;
  c.pitch_error = PitchErrorExtension{2.0, {0, 0}, {1, 2}};
  EXPECT_THROW(KnownEffects(c, kMechanics, 0.0), std::invalid_argument);
  c.pitch_error = PitchErrorExtension{2.0, {0, 1}, {1}};
  EXPECT_THROW(KnownEffects(c, kMechanics, 0.0), std::invalid_argument);
}

TEST(KnownEffectsTest, ViscousFrictionOfEitherDirection) {
  ExtensionsConfig c;
  c.asymmetric_viscous = AsymmetricViscousExtension{0.4};
  const KnownEffects known(c, kMechanics, 500.0);
  EXPECT_FALSE(known.neutral());
  // Beside sigma2 v: 600 v upwards, 400 v downwards.
  EXPECT_NEAR(known.Viscous_N(0.1, kNoTemperature), 10.0, 1e-12);
  EXPECT_NEAR(known.Viscous_N(-0.1, kNoTemperature), 10.0, 1e-12);
}

}  // namespace
}  // namespace contour
