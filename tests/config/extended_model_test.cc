#include "config/extended_model.h"

#include <gtest/gtest.h>

#include <numbers>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "tests/config/test_files.h"

namespace contour {
namespace {

ModelConfig Model(const std::string& extensions) {
  return LoadMachine(ExampleMachine("xy_emulated.yaml"), {"axes.x.model.extensions={" + extensions + "}"})
      .axes.at("x")
      .model;
}

TEST(ExtendedModelTest, WithoutExtensionsItIsTheModel) {
  const ModelConfig m = Model("");
  const ExtendedModel e = Extended(m);
  EXPECT_EQ(e.friction.Fc_plus_N, m.friction.Fc_plus_N);
  EXPECT_EQ(e.mechanics.screw_stiffness_N_um, m.mechanics.screw_stiffness_N_um);
  EXPECT_EQ(e.added_lag_s, 0.0);
}

TEST(ExtendedModelTest, OtherNumbersForTheBasicModel) {
  const ModelConfig m = Model(
      "asymmetric_coulomb: {difference_rel: 0.2}, stribeck: {Fs_over_Fc: 1.5, vs_rad_s: 3}, "
      "compliance: {stiffness_Nm_rad: 20, damping_ratio: 0.03}, input_delay: {delay_us: 150}, "
      "current_lag: {time_constant_us: 50}");
  const ExtendedModel e = Extended(m);
  EXPECT_NEAR(e.friction.Fc_plus_N, 1.1 * m.friction.Fc_plus_N, 1e-9);
  EXPECT_NEAR(e.friction.Fc_minus_N, 0.9 * m.friction.Fc_minus_N, 1e-9);
  EXPECT_NEAR(e.friction.Fs_plus_N, 1.5 * 1.1 * m.friction.Fc_plus_N, 1e-9);
  const double r = 5e-3 / (2.0 * std::numbers::pi);
  EXPECT_NEAR(e.friction.vs_mm_s, 3e3 * r, 1e-9);
  EXPECT_NEAR(e.mechanics.screw_stiffness_N_um, 20e-6 / (r * r), 1e-9);
  EXPECT_NEAR(e.added_delay_s, 150e-6, 1e-12);
  EXPECT_NEAR(e.added_lag_s, 50e-6, 1e-12);
}

TEST(ExtendedModelTest, ATorqueConstantScalesAllThatResists) {
  const ModelConfig m = Model("torque_constant: {ratio: 1.25}");
  const ExtendedModel e = Extended(m);
  EXPECT_NEAR(e.mechanics.motor_inertia_kgm2, 0.8 * m.mechanics.motor_inertia_kgm2, 1e-15);
  EXPECT_NEAR(e.mechanics.table_mass_kg, 0.8 * m.mechanics.table_mass_kg, 1e-12);
  EXPECT_NEAR(e.friction.sigma2_Ns_m, 0.8 * m.friction.sigma2_Ns_m, 1e-9);
}

TEST(ExtendedModelTest, ReadStrictly) {
  const auto error = [](const std::string& extensions) -> std::string {
    try {
      Model(extensions);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(error("coging: {amplitude_Nm: 1}").find("did you mean cogging"), std::string::npos);
  EXPECT_NE(error("cogging: {amplitude_Nm: 1}").find("order_per_rev: missing"), std::string::npos);
  EXPECT_NE(error("pitch_error: {position_mm: [0, 1], error_um: [1]}").find("as many of both"),
            std::string::npos);
  EXPECT_NE(error("pitch_error: {position_mm: [1, 0], error_um: [1, 2]}").find("ascend"), std::string::npos);
}

}  // namespace
}  // namespace contour
