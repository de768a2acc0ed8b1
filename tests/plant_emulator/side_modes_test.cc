// A part of the table that swings on a spring: what the step keeps, and where modes and antiresonances lie,
// against the eigenvalues of mass and stiffness matrices.
#include "tools/plant_emulator/side_modes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "tests/plant_emulator/drive_harness.h"
#include "tools/plant_emulator/axis_plant.h"

namespace contour::plant {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kRadius_m_rad = 5e-3 / kTwoPi;

EmulatedAxisConfig Frictionless(double damping_Ns_m, double side_damping) {
  EmulatedAxisConfig c = test::NominalAxis();
  c.table_mass_kg = 20.0;
  c.friction.Fs_plus_N = c.friction.Fs_minus_N = c.friction.Fc_plus_N = c.friction.Fc_minus_N = 0.0;
  c.friction.sigma0_N_m = 1e3;
  c.friction.sigma1_Ns_m = c.friction.sigma2_Ns_m = 0.0;
  c.screw_damping_Ns_m = damping_Ns_m;
  c.start_variation_mm = 0.0;
  c.side_modes = {{175.0, 0.12, side_damping}, {95.0, 0.05, side_damping}};
  return c;
}
AxisPlant Make(const EmulatedAxisConfig& c) {
  AxisParameters p = MakeAxisParameters(c, test::Place("x", 1), 1, 0.0, 0);
  p.start_bristle_N = 0.0;
  return AxisPlant(p);
}

TEST(SideModes, KeepEnergyWithoutDamping) {
  AxisPlant plant = Make(Frictionless(0.0, 0.0));
  plant.SetState(5e-6, 0.02, 0.0, -0.01);
  const double energy = plant.energy_J();
  for (int i = 0; i < 50000; ++i) plant.Step(5e-5, 0.0);
  EXPECT_NEAR(plant.energy_J(), energy, 1e-4 * energy);
}

TEST(SideModes, WorkOfTheMotorIsEnergyAndTheirMassIsTheTables) {
  AxisPlant plant = Make(Frictionless(0.0, 0.0));
  double work = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double before = plant.motor_angle_rad();
    plant.Step(5e-5, 0.1);
    work += 0.1 * (plant.motor_angle_rad() - before);
  }
  EXPECT_NEAR(plant.energy_J(), work, 1e-4 * work);
  // All of the axis is under way together: the whole mass, with what swings.
  const double mass_kg = 5e-5 / (kRadius_m_rad * kRadius_m_rad) + 20.0;
  EXPECT_NEAR(plant.table_velocity_m_s(), 0.1 / kRadius_m_rad / mass_kg * 0.2, 2e-3);
}

TEST(SideModes, DampingTakesEnergyOnly) {
  AxisPlant plant = Make(Frictionless(0.0, 0.05));
  plant.SetState(5e-6, 0.02, 0.0, -0.01);
  double energy = plant.energy_J();
  for (int i = 0; i < 2000; ++i) {
    plant.Step(5e-5, 0.0);
    ASSERT_LE(plant.energy_J(), energy * (1.0 + 1e-12)) << i;
    energy = plant.energy_J();
  }
}

/// Motor acceleration per torque at each frequency, from one chirp.
std::vector<double> Response(AxisPlant& plant, const std::vector<double>& frequency_Hz) {
  const double h = 4e-5, duration_s = 8.0, from_Hz = 40.0, to_Hz = 420.0;
  const auto steps = static_cast<std::size_t>(duration_s / h);
  std::vector<std::complex<double>> in(frequency_Hz.size()), out(frequency_Hz.size()),
      turn(frequency_Hz.size(), 1.0), by(frequency_Hz.size());
  for (std::size_t f = 0; f < by.size(); ++f) by[f] = std::polar(1.0, -kTwoPi * frequency_Hz[f] * h);
  for (std::size_t i = 0; i < steps; ++i) {
    const double t = static_cast<double>(i) * h;
    // Ends before the record does, so that the ringing after it counts, too.
    const double swept_s = 0.5 * duration_s;
    const double torque =
        t < swept_s ? 0.1 * std::sin(kTwoPi * (from_Hz + 0.5 * (to_Hz - from_Hz) * t / swept_s) * t) : 0.0;
    const double before = plant.motor_velocity_m_s();
    plant.Step(h, torque);
    const double change =
        plant.motor_velocity_m_s() - before;  // its own whole motion goes on after the chirp
    for (std::size_t f = 0; f < by.size(); ++f) {
      in[f] += torque * turn[f];
      out[f] += change * turn[f];
      turn[f] *= by[f];
    }
  }
  std::vector<double> gain;
  for (std::size_t f = 0; f < by.size(); ++f) gain.push_back(std::abs(out[f] / in[f]));
  return gain;
}

/// Frequencies of the undamped system of masses and springs that the axis is; `held`: its first mass stands.
std::vector<double> Modes_Hz(const EmulatedAxisConfig& c, bool held) {
  const auto n = static_cast<Eigen::Index>(2 + c.side_modes.size());
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n), stiffness = mass;
  const auto join = [&](Eigen::Index a, Eigen::Index b, double k) {
    stiffness(a, a) += k, stiffness(b, b) += k, stiffness(a, b) -= k, stiffness(b, a) -= k;
  };
  mass(0, 0) = c.motor_inertia_kgm2 / (kRadius_m_rad * kRadius_m_rad);
  mass(1, 1) = c.table_mass_kg;
  join(0, 1, c.screw_stiffness_N_um * 1e6);
  for (Eigen::Index i = 2; i < n; ++i) {
    const EmulatedSideModeConfig& mode = c.side_modes[static_cast<std::size_t>(i - 2)];
    mass(i, i) = mode.mass_share_rel * c.table_mass_kg;
    mass(1, 1) -= mass(i, i);
    join(1, i, mass(i, i) * std::pow(kTwoPi * mode.frequency_Hz, 2));
  }
  const Eigen::Index from = held ? 1 : 0, size = n - from;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solved(
      stiffness.block(from, from, size, size), mass.block(from, from, size, size));
  std::vector<double> modes_Hz;
  for (const double squared : solved.eigenvalues())
    if (squared > 1.0) modes_Hz.push_back(std::sqrt(squared) / kTwoPi);
  return modes_Hz;
}

TEST(SideModes, AChirpShowsModesAndAntiresonancesWhereTheEigenvaluesAre) {
  const EmulatedAxisConfig c = Frictionless(150.0, 0.004);
  AxisPlant plant = Make(c);
  std::vector<double> frequency_Hz;
  for (double f = 60.0; f < 400.0; f += 0.25) frequency_Hz.push_back(f);
  const std::vector<double> gain = Response(plant, frequency_Hz);
  std::vector<double> peaks_Hz, dips_Hz;
  for (std::size_t i = 1; i + 1 < gain.size(); ++i) {
    if (gain[i] > gain[i - 1] && gain[i] >= gain[i + 1]) peaks_Hz.push_back(frequency_Hz[i]);
    if (gain[i] < gain[i - 1] && gain[i] <= gain[i + 1]) dips_Hz.push_back(frequency_Hz[i]);
  }
  const std::vector<double> modes_Hz = Modes_Hz(c, false), held_Hz = Modes_Hz(c, true);
  ASSERT_EQ(modes_Hz.size(), 3U);
  ASSERT_EQ(peaks_Hz.size(), modes_Hz.size());
  for (std::size_t i = 0; i < modes_Hz.size(); ++i)
    EXPECT_NEAR(peaks_Hz[i], modes_Hz[i], 0.004 * modes_Hz[i]) << "mode " << i;
  ASSERT_EQ(dips_Hz.size(), held_Hz.size());
  for (std::size_t i = 0; i < held_Hz.size(); ++i)
    EXPECT_NEAR(dips_Hz[i], held_Hz[i], 0.004 * held_Hz[i]) << "antiresonance " << i;
}

TEST(SideModes, WhatSwingsMustLeaveATable) {
  EmulatedAxisConfig c = Frictionless(0.0, 0.0);
  c.side_modes = {{100.0, 0.6, 0.02}, {200.0, 0.4, 0.02}};
  EXPECT_THROW(Make(c), std::invalid_argument);
}

}  // namespace
}  // namespace contour::plant
