#include "analysis/identification/spread_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "analysis/identification/joint_fit.h"
#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

TEST(SpreadGroupsTest, WindowsOfQuickForcesComeLast) {
  identify::Measured data;
  data.period_s = 1e-3;
  for (int k = 0; k < 90; ++k) {
    const double frequency = k < 30 ? 0.3 : k < 60 ? 0.1 : 0.2;
    data.force_N.push_back(std::sin(6.283185307179586 * frequency * k));
    data.position_m.push_back(k < 30 ? 0.0 : 1e-6 * k);
    data.present.push_back(1);
  }
  const identify::SpreadWindows w = identify::WindowsOf({data});
  ASSERT_EQ(w.length, 30);
  ASSERT_EQ(w.quickness.size(), 3U);
  EXPECT_GT(w.quickness[0], w.quickness[2]);
  EXPECT_GT(w.quickness[2], w.quickness[1]);
  EXPECT_EQ(w.velocity_m_s[0], 0.0);
  EXPECT_GT(w.velocity_m_s[1], 0.0);
  data.run_up = 30;
  const identify::SpreadWindows behind = identify::WindowsOf({data});
  EXPECT_EQ(behind.quickness, std::vector<double>(w.quickness.begin() + 1, w.quickness.end()));
  EXPECT_EQ(behind.velocity_m_s, std::vector<double>(w.velocity_m_s.begin() + 1, w.velocity_m_s.end()));
}

TEST(SpreadGroupsTest, WhatGoesWithTheKeyIsSeenAndNoiseIsNotMadeMore) {
  constexpr int kWindows = 640;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd each(kWindows, 2);
  std::vector<double> key;
  for (int w = 0; w < kWindows; ++w) {
    // Over and over the same eight values: in order of time they cancel.
    const double at = w % 8;
    key.push_back(at);
    each(w, 0) = normal(random);
    each(w, 1) = normal(random) + (at < 4.0 ? 1.0 : -1.0);
  }
  const Eigen::VectorXd variance = identify::ScatterOverGroups(each, key);
  EXPECT_NEAR(std::sqrt(variance(0) / kWindows), 1.3, 0.7);
  EXPECT_GT(std::sqrt(variance(1) / kWindows), 6.0);
}

// A part that swings, which two masses do not have: every sweep of the chirp finds them wrong in the same
// way, and no block of time shows it. Slow and quick forces tell of two tables.
TEST(SpreadGroupsTest, HalvesOfTheFrequenciesDisagreeAboutWhatTheModelHasNot) {
  const auto fitted = [](const plant::AxisParameters& truth) {
    const GeneratedAxis axis{truth};
    const identify::Measured data = axis.Drive(
        8.0, [](double t) { return 5e-3 * t; },
        [](double t) {
          const double s = std::fmod(t, 0.5);
          return 60.0 * std::sin(6.283185307179586 * (100.0 * s + 0.5 * 760.0 * s * s));
        });
    identify::TableAxis start = Exactly(truth);
    start.variation.high_m = 40e-3;
    identify::FitOptions options;
    options.block_s = 0.5;
    options.only = {"motor_inertia_kgm2",
                    "table_mass_kg",
                    "screw_damping_Ns_m",
                    "screw_stiffness_N_um",
                    "lag_s",
                    "delay_s",
                    "Fc_plus_N",
                    "sigma0_N_m"};
    return identify::FitJointly(start, {data}, options);
  };
  const auto find = [](const identify::JointFit& fit, const char* key) {
    for (const identify::FittedParameter& p : fit.parameters)
      if (p.key == key) return p;
    return identify::FittedParameter{};
  };
  const auto apart = [&](const identify::JointFit& fit, const char* key) {
    return find(fit, key).halves_apart;
  };
  plant::AxisParameters plain = PlainAxis();
  plain.table_mass_kg = 30.0;
  plant::AxisParameters swings = plain;
  const double omega = 6.283185307179586 * 150.0;
  swings.side_modes = {{3.6, 3.6 * omega * omega, 0.04 * 3.6 * omega}};
  const auto with = fitted(swings), without = fitted(plain);
  for (const char* key : {"motor_inertia_kgm2", "table_mass_kg", "screw_stiffness_N_um"}) {
    EXPECT_GT(apart(with, key), 4.0) << key;
    EXPECT_LT(apart(without, key), 3.0) << key;
  }
  const double error = std::log(with.axis.load_inertia / Exactly(swings).load_inertia);
  EXPECT_GT(std::fabs(error), 3.0 * identify::Sigma(with.parameters, "table_mass_kg"));
  const identify::FittedParameter table = find(with, "table_mass_kg");
  EXPECT_LT(std::fabs(error), 3.0 * table.sigma * table.halves_apart);
  EXPECT_LT(std::fabs(error), 1.96 * std::hypot(table.sigma, table.halves_distance));
  EXPECT_LT(find(without, "table_mass_kg").halves_distance, 0.2 * table.halves_distance);
}

}  // namespace
}  // namespace contour::test
