#include "tools/plant_emulator/axis_plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/plant_emulator/drive_harness.h"

namespace contour::plant {
namespace {

using test::NominalAxis;
using test::Place;

AxisParameters Nominal(const EmulatedAxisConfig& config = NominalAxis()) {
  AxisParameters p = MakeAxisParameters(config, Place("x", 1), 1, 0.0, 0);
  p.start_position_m = 0.0;
  p.start_bristle_N = 0.0;
  return p;
}
AxisParameters Frictionless(double damping_Ns_m) {
  EmulatedAxisConfig c = NominalAxis();
  c.friction.Fs_plus_N = c.friction.Fs_minus_N = c.friction.Fc_plus_N = c.friction.Fc_minus_N = 0.0;
  c.friction.sigma0_N_m = 1e3;
  c.friction.sigma1_Ns_m = c.friction.sigma2_Ns_m = 0.0;
  c.screw_damping_Ns_m = damping_Ns_m;
  return Nominal(c);
}
double MotorMass_kg(const AxisParameters& p) {
  return p.motor_inertia_kgm2 / (p.radius_m_rad * p.radius_m_rad);
}

TEST(AxisPlant, KeepsEnergyAndMomentumWithoutFrictionAndDamping) {
  const AxisParameters p = Frictionless(0.0);
  AxisPlant plant(p);
  plant.SetState(5e-6, 0.02, 0.0, -0.01);
  const double energy = plant.energy_J();
  const double momentum = MotorMass_kg(p) * 0.02 - p.table_mass_kg * 0.01;
  for (int i = 0; i < 50000; ++i) plant.Step(5e-5, 0.0);
  EXPECT_NEAR(plant.energy_J(), energy, 1e-4 * energy);
  EXPECT_NEAR(MotorMass_kg(p) * plant.motor_velocity_m_s() + p.table_mass_kg * plant.table_velocity_m_s(),
              momentum, 1e-5 * momentum);
}

TEST(AxisPlant, WorkOfTheMotorBecomesEnergy) {
  AxisPlant plant(Frictionless(0.0));
  double work = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double torque = 0.2 * std::sin(0.01 * i);
    const double before = plant.motor_angle_rad();
    plant.Step(5e-5, torque);
    work += torque * (plant.motor_angle_rad() - before);
  }
  EXPECT_GT(work, 1e-3);
  EXPECT_NEAR(plant.energy_J(), work, 1e-4 * work);
}

TEST(AxisPlant, FrictionTakesWhatTheMotorGives) {
  // From rest to rest all work went into friction, by the truth's own friction force.
  AxisPlant plant(Nominal());
  const double h = plant.MaxStep_s();
  double work = 0.0;
  double heat = 0.0;
  for (double t = 0.0; t < 1.5; t += h) {
    const double torque = t < 0.4 ? 0.12 : t < 0.8 ? -0.10 : 0.0;
    const double angle = plant.motor_angle_rad();
    const double table = plant.table_position_m();
    const double friction = plant.friction_N();
    const double windup_rate = plant.motor_velocity_m_s() - plant.table_velocity_m_s();
    plant.Step(h, torque);
    work += torque * (plant.motor_angle_rad() - angle);
    heat += 0.5 * (friction + plant.friction_N()) * (plant.table_position_m() - table) +
            1100.0 * windup_rate * windup_rate * h;
  }
  EXPECT_LT(std::fabs(plant.table_velocity_m_s()), 1e-4);
  EXPECT_GT(work, 1.0);
  EXPECT_NEAR(heat, work, 2e-3 * work);
}

TEST(AxisPlant, ScrewModeLiesAt338HzWithDampingOf2Point9Percent) {
  const AxisParameters p = Frictionless(1100.0);
  AxisPlant plant(p);
  plant.SetState(1e-6, 0.0, 0.0, 0.0);
  const double h = plant.MaxStep_s();
  std::vector<double> peak;
  std::vector<double> peak_s;
  double old = 0.0;
  double older = 0.0;
  for (int i = 1; i < 2000; ++i) {
    plant.Step(h, 0.0);
    const double windup = plant.motor_position_m() - plant.table_position_m();
    if (i > 2 && old > older && old > windup && old > 0.0) {
      const double shift =
          0.5 * (older - windup) / (older - 2.0 * old + windup);  // parabola through three points
      peak.push_back(old - 0.25 * (older - windup) * shift);
      peak_s.push_back((i - 1 + shift) * h);
    }
    older = old;
    old = windup;
  }
  ASSERT_GE(peak.size(), 11U);
  const double period = (peak_s[10] - peak_s[0]) / 10.0;
  const double decrement = std::log(peak[0] / peak[10]) / 10.0;
  const double zeta = decrement / std::hypot(decrement, 2.0 * std::numbers::pi);
  EXPECT_NEAR(1.0 / period, 338.0, 2.0);
  EXPECT_NEAR(zeta, 0.0292, 0.0005);
}

/// Table position after a fixed history of torque, in um, with the sub-step divided.
double After(const AxisParameters& p, int divide, double scale = 1.0) {
  AxisPlant plant(p);
  const double grid = 1e-3;
  const int steps = static_cast<int>(std::ceil(grid / plant.MaxStep_s())) * divide;
  for (int k = 0; k < 600; ++k)
    for (int i = 0; i < steps; ++i) plant.Step(grid / steps, scale * (k % 200 < 100 ? 0.09 : -0.08));
  return 1e6 * plant.table_position_m();
}

TEST(AxisPlant, SubStepIsFineEnough) {
  // Several millimetres with reversals: the sub-step in use stays within a micrometre of one sixteen times
  // finer.
  for (const double sigma0 : {1e6, 5e6, 3e7}) {
    EmulatedAxisConfig c = NominalAxis();
    c.friction.sigma0_N_m = sigma0;
    const double fine = After(Nominal(c), 16);
    EXPECT_GT(std::fabs(fine), 300.0);
    EXPECT_NEAR(After(Nominal(c), 1), fine, 1.0) << sigma0;
  }
}

TEST(AxisPlant, StiffFrictionIsStable) {
  for (const auto law : {EmulatedFrictionLaw::kLugre, EmulatedFrictionLaw::kMaxwellSlip}) {
    EmulatedAxisConfig c = NominalAxis();
    c.friction.sigma0_N_m = 3e7;
    c.friction.law = law;
    AxisPlant plant(Nominal(c));
    // Held below break-away for a second, then let go: it creeps nowhere and rests.
    for (int i = 0; i < 20000; ++i) plant.Step(5e-5, 0.02);
    const double held = plant.table_position_m();
    EXPECT_LT(std::fabs(held), 10e-6);
    EXPECT_LT(std::fabs(plant.table_velocity_m_s()), 1e-6);
    for (int i = 0; i < 20000; ++i) plant.Step(5e-5, 0.0);
    EXPECT_LT(std::fabs(plant.table_velocity_m_s()), 1e-6);
  }
}

TEST(AxisPlant, NothingDiesAwayIntoSubnormalNumbers) {
  AxisParameters p = Nominal();
  p.start_bristle_N =
      5.0;  // the only thing that moves: all decays to nothing, which would make every step slow
  AxisPlant plant(p);
  for (int i = 0; i < 1500000; ++i) {
    plant.Step(6e-5, 0.0);
    ASSERT_NE(std::fpclassify(plant.table_velocity_m_s()), FP_SUBNORMAL) << i;
    ASSERT_NE(std::fpclassify(plant.elastic_N()), FP_SUBNORMAL) << i;
  }
  EXPECT_NEAR(plant.table_velocity_m_s(), 0.0, 1e-15);
}

TEST(AxisPlant, WindUpOfTheScrewIsForceOverStiffness) {
  AxisPlant plant(Nominal());
  // Steady sliding: the screw carries friction.
  for (int i = 0; i < 30000; ++i) plant.Step(5e-5, 0.06);
  ASSERT_GT(plant.table_velocity_m_s(), 0.01);
  ASSERT_LT(plant.table_position_m(), 0.2);
  const double windup = plant.motor_position_m() - plant.table_position_m();
  EXPECT_NEAR(windup, (plant.friction_N() + 10.0 * plant.table_acceleration_m_s2()) / 40e6, 1e-9);
}

}  // namespace
}  // namespace contour::plant
