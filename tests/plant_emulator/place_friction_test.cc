// Friction that acts on the motor before the screw, and what carries a vertical axis, against sums done by
// hand.
#include "tools/plant_emulator/place_friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/plant_emulator/drive_harness.h"
#include "tools/plant_emulator/axis_plant.h"

namespace contour::plant {
namespace {

constexpr double kRadius_m_rad = 5e-3 / (2.0 * std::numbers::pi);

EmulatedAxisConfig Plain(EmulatedFrictionLaw law, double motor_share) {
  EmulatedAxisConfig c = test::NominalAxis();
  auto& f = c.friction;
  f.law = law;
  f.Fs_plus_N = f.Fs_minus_N = f.Fc_plus_N = f.Fc_minus_N = 40.0;
  f.sigma2_Ns_m = 300.0;
  f.position_amplitude_rel = f.ripple_amplitude_rel = 0.0;
  f.motor_share_rel = motor_share;
  c.start_variation_mm = 0.0;
  return c;
}
AxisPlant Make(const EmulatedAxisConfig& c) {
  AxisParameters p = MakeAxisParameters(c, test::Place("x", 1), 1, 0.0, 0);
  p.start_bristle_N = 0.0;
  return AxisPlant(p);
}

class MotorFriction : public ::testing::TestWithParam<EmulatedFrictionLaw> {};

// Steady sliding: the motor gives the whole, the screw carries the table's share only.
TEST_P(MotorFriction, TheScrewCarriesTheTablesShareOnly) {
  for (const double share : {0.0, 0.3, 0.8}) {
    double windup_m[2] = {};
    for (const double direction : {1.0, -1.0}) {
      AxisPlant plant = Make(Plain(GetParam(), share));
      const double force_N = 40.0 + 300.0 * 0.03;
      for (int i = 0; i < 60000; ++i) plant.Step(4e-5, direction * force_N * kRadius_m_rad);
      // The torque is that of 30 mm/s: friction is what it says, wherever it acts.
      ASSERT_NEAR(plant.table_velocity_m_s() * direction, 0.03, 2e-3) << share;
      EXPECT_NEAR(plant.friction_N() * direction, 40.0 + 300.0 * plant.table_velocity_m_s() * direction, 0.1);
      windup_m[direction < 0.0] = plant.motor_position_m() - plant.table_position_m();
    }
    // Lost motion between the directions: twice the table's friction over the stiffness.
    EXPECT_NEAR(windup_m[0] - windup_m[1], 2.0 * (1.0 - share) * 49.0 / 40e6, 0.03e-6) << share;
  }
}

// From rest to rest all work went into friction, wherever it acts.
TEST_P(MotorFriction, TakesWhatTheMotorGives) {
  AxisPlant plant = Make(Plain(GetParam(), 0.4));
  const double h = plant.MaxStep_s();
  double work_J = 0.0, heat_J = 0.0;
  for (double t = 0.0; t < 1.5; t += h) {
    const double torque = t < 0.4 ? 0.12 : t < 0.8 ? -0.10 : 0.0;
    const double angle = plant.motor_angle_rad(), table = plant.table_position_m(),
                 friction = plant.friction_N();
    const double screw_m_s = plant.motor_velocity_m_s() - plant.table_velocity_m_s();
    plant.Step(h, torque);
    work_J += torque * (plant.motor_angle_rad() - angle);
    heat_J += 0.5 * (friction + plant.friction_N()) * (plant.table_position_m() - table) +
              1100.0 * screw_m_s * screw_m_s * h;
  }
  EXPECT_LT(std::fabs(plant.table_velocity_m_s()), 1e-4);
  EXPECT_GT(work_J, 1.0);
  EXPECT_NEAR(heat_J, work_J, 3e-3 * work_J);
}

// A torque below the motor's own friction bends its bristles and nothing else: the table hardly feels it.
TEST_P(MotorFriction, HoldsTheMotorInFrontOfTheScrew) {
  const auto at_rest_m = [&](double share) {
    AxisPlant plant = Make(Plain(GetParam(), share));
    for (int i = 0; i < 20000; ++i) plant.Step(4e-5, 10.0 * kRadius_m_rad);
    return plant.table_position_m();
  };
  EXPECT_LT(std::fabs(at_rest_m(0.9)), 1.2 * std::fabs(at_rest_m(0.0)));
  AxisPlant plant = Make(Plain(GetParam(), 0.9));
  for (int i = 0; i < 20000; ++i) plant.Step(4e-5, 10.0 * kRadius_m_rad);
  // Of 10 N the screw carries about the table's tenth.
  EXPECT_NEAR(plant.motor_position_m() - plant.table_position_m(), 0.1 * 10.0 / 40e6, 0.015e-6);
}

INSTANTIATE_TEST_SUITE_P(Laws, MotorFriction,
                         ::testing::Values(EmulatedFrictionLaw::kLugre, EmulatedFrictionLaw::kMaxwellSlip),
                         [](const auto& law) { return std::string(Name(law.param)); });

EmulatedAxisConfig Vertical(double force_N, double moving_mass_kg, double rate_N_mm) {
  EmulatedAxisConfig c = Plain(EmulatedFrictionLaw::kLugre, 0.0);
  auto& f = c.friction;
  f.Fs_plus_N = f.Fs_minus_N = f.Fc_plus_N = f.Fc_minus_N = 0.0;
  f.sigma0_N_m = 1e3;
  f.sigma1_Ns_m = f.sigma2_Ns_m = 0.0;
  c.screw_damping_Ns_m = 0.0;
  c.counterbalance = EmulatedCounterbalanceConfig{force_N, moving_mass_kg, rate_N_mm};
  return c;
}

TEST(Counterbalance, PushesAndIsMovedAlong) {
  const double motor_kg = 5e-5 / (kRadius_m_rad * kRadius_m_rad);
  for (const double moving_kg : {0.0, 30.0}) {
    AxisPlant plant = Make(Vertical(12.0, moving_kg, 0.0));
    for (int i = 0; i < 5000; ++i) plant.Step(4e-5, 0.0);
    EXPECT_NEAR(plant.table_velocity_m_s(), 12.0 / (motor_kg + 10.0 + moving_kg) * 0.2, 5e-4) << moving_kg;
  }
}

TEST(Counterbalance, GasIsASpringUnderTheWholeAxis) {
  // Half a period of the whole axis on 200 N/mm, from 0.1 mm above the middle to 0.1 mm below.
  AxisPlant plant = Make(Vertical(0.0, 5.0, 200.0));
  plant.SetState(1e-4, 0.0, 1e-4, 0.0);
  const double mass_kg = 5e-5 / (kRadius_m_rad * kRadius_m_rad) + 15.0;
  const double half_period_s = std::numbers::pi * std::sqrt(mass_kg / 2e5);
  const double energy_J = plant.energy_J() + 0.5 * 2e5 * 1e-8;
  const int steps = 1000;
  for (int i = 0; i < steps; ++i) plant.Step(half_period_s / steps, 0.0);
  // The screw, two hundred times as stiff, makes the period longer by little.
  EXPECT_NEAR(plant.table_position_m(), -1e-4, 1.5e-6);
  const double x = plant.table_position_m();
  EXPECT_NEAR(plant.energy_J() + 0.5 * 2e5 * x * x, energy_J, 1e-3 * energy_J);
}

}  // namespace
}  // namespace contour::plant
