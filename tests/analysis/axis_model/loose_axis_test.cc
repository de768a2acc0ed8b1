#include "analysis/axis_model/loose_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "analysis/axis_model/read_stated_axis.h"
#include "config/config_error.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

std::string Error(const std::string& text) {
  try {
    ReadStatedAxis(WriteTestFile("model.yaml", text), "");
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(LooseAxis, RigidRotaryModelAlone) {
  const StatedAxis a = ReadStatedAxis(WriteTestFile("model.yaml", R"(
model:
  lead_mm: 5
  motor_inertia_kgm2: 5e-5
  table_mass_kg: 10
  friction: {acts_on: motor, stribeck_exponent: 2, Fc_plus_Nm: 0.03, Fc_minus_Nm: 0.032, Fs_plus_Nm: 0.04,
             Fs_minus_Nm: 0.041, vs_rad_s: 2, sigma0_Nm_rad: 3, sigma1_Nms_rad: 0.002, sigma2_Nms_rad: 3e-4}
  uncertainty: {motor_inertia_kgm2: 0.05, table_mass_kg: 0.1, Fc_plus_Nm: 0.1, torque_constant: 0.02, delay_ms: 0.01}
drive: {delay_ms: 1, lag_ms: 0.2, encoder_counts_per_rev: 1048576, torque_step_Nm: 0.000637, rated_torque_Nm: 0.637,
        stroke_mm: [-200, 200]}
)"),
                                      "");
  const double r = 5e-3 / kTwoPi;
  EXPECT_FALSE(a.two_inertia);
  EXPECT_FALSE(a.linear);
  EXPECT_DOUBLE_EQ(a.motor_inertia, 5e-5 + 10 * r * r);
  EXPECT_DOUBLE_EQ(a.friction.Fs_plus, 0.04);
  EXPECT_DOUBLE_EQ(a.friction.s0, 3);
  EXPECT_DOUBLE_EQ(a.friction.vd, 0.0);
  EXPECT_DOUBLE_EQ(a.position_step, kTwoPi / 1048576);
  EXPECT_DOUBLE_EQ(a.rated, 0.637);
  EXPECT_DOUBLE_EQ(a.sigma.at("torque_constant"), 0.02);
  EXPECT_DOUBLE_EQ(a.sigma.at("delay"), 0.01);
  EXPECT_NEAR(a.sigma.at("inertia"), std::hypot(0.05 * 5e-5, 0.1 * 10 * r * r) / (5e-5 + 10 * r * r), 1e-12);
}

TEST(LooseAxis, LinearModelOfAFewKeys) {
  const StatedAxis a = ReadStatedAxis(WriteTestFile("model.yaml", R"(
mass_kg: 95.1089
lead_mm: 2.5
constant_force_N: -3.1648
friction: {Fc_plus_N: 20.3935, Fc_minus_N: 20.3935, sigma2_Ns_m: 203.5034}
)"),
                                      "");
  EXPECT_TRUE(a.linear);
  EXPECT_FALSE(a.two_inertia);
  EXPECT_DOUBLE_EQ(a.motor_inertia, 95.1089);
  EXPECT_DOUBLE_EQ(a.friction.s2, 203.5034);
  EXPECT_DOUBLE_EQ(a.friction.Fs_plus, 20.3935);
  EXPECT_GT(a.friction.s0, 1e6);
  EXPECT_DOUBLE_EQ(a.offset, -3.1648);
  EXPECT_DOUBLE_EQ(a.lead_m, 2.5e-3);
}

TEST(LooseAxis, ExtensionsOfALinearAxisAreInNewtons) {
  const std::string linear = "mass_kg: 95\nfriction: {Fc_plus_N: 20, Fc_minus_N: 20, sigma2_Ns_m: 200}\n";
  EXPECT_EQ(Error(linear), "");
  const StatedAxis a = ReadStatedAxis(
      WriteTestFile("model.yaml", linear + "extensions:\n  constant_torque: {force_N: 0.5}\n"
                                           "  cogging: {amplitude_N: 1.4, order_per_rev: 1, phase_rad: 0.2}\n"
                                           "  asymmetric_viscous: {difference_rel: -0.35}\n"),
      "");
  EXPECT_DOUBLE_EQ(a.offset, 0.5);
  EXPECT_DOUBLE_EQ(a.extras.cogging.at(0).amplitude, 1.4);
  EXPECT_DOUBLE_EQ(a.extras.viscous_difference_rel, -0.35);
  const std::string error = Error(linear + "extensions: {constant_torque: {torque_Nm: 0.1}}\n");
  EXPECT_NE(error.find("expected force_N on this axis"), std::string::npos) << error;
}

TEST(LooseAxis, AModelWithNothingButInertiaLeavesTheRestOpen) {
  const StatedAxis a = ReadStatedAxis(WriteTestFile("model.yaml", "model: {motor_inertia_kgm2: 1e-4}\n"), "");
  EXPECT_EQ(a.open, (std::set<std::string>{"Fc", "exponent", "s0", "s2", "stroke", "vs"}));
  EXPECT_EQ(ReadStatedAxis(WriteTestFile("model.yaml", "mass_kg: 3\n"), "").open.count("Fc"), 1U);
}

TEST(LooseAxis, GearEndlessAndCurrent) {
  const StatedAxis a = ReadStatedAxis(WriteTestFile("model.yaml",
                                                    "model: {motor_inertia_kgm2: 10, gear_ratio: 101}\n"
                                                    "drive: {endless: true, torque_constant_Nm_A: 9.5}\n"),
                                      "");
  EXPECT_DOUBLE_EQ(a.gear_ratio, 101.0);
  EXPECT_DOUBLE_EQ(a.torque_constant, 9.5);
  EXPECT_TRUE(a.endless);
  EXPECT_FALSE(a.to_and_fro);
  const std::string not_endless = "model: {motor_inertia_kgm2: 10}\ndrive: {endless: false}\n";
  EXPECT_TRUE(ReadStatedAxis(WriteTestFile("model.yaml", not_endless), "").to_and_fro);
  // Without a lead, places are in rad.
  EXPECT_DOUBLE_EQ(a.table_per_q, 1.0);
  EXPECT_NE(Error("model: {motor_inertia_kgm2: 10, gear_ratio: 3, lead_mm: 5}\n").find("gear_ratio"),
            std::string::npos);
  EXPECT_NE(Error("model: {mass_kg: 10, gear_ratio: 3}\n").find("found on a linear axis"), std::string::npos);
}

TEST(LooseAxis, ValuesInNmSayThatFrictionActsOnTheMotor) {
  const StatedAxis a = ReadStatedAxis(
      WriteTestFile("model.yaml",
                    "motor_inertia_kgm2: 1e-4\nfriction: {Fc_plus_Nm: 0.03, sigma2_Nms_rad: 1e-4}\n"),
      "");
  EXPECT_DOUBLE_EQ(a.friction.Fc_minus, 0.03);
  EXPECT_FALSE(a.open.contains("Fc"));
}

TEST(LooseAxis, AShareOfTheFrictionMayActOnTheMotor) {
  const StatedAxis a = ReadStatedAxis(WriteTestFile("model.yaml", R"(
lead_mm: 5
motor_inertia_kgm2: 5e-5
table_mass_kg: 10
screw_stiffness_N_um: 40
friction: {acts_on: table, motor_share_rel: 0.3, Fc_plus_N: 40, Fc_minus_N: 40, sigma2_Ns_m: 400}
side_modes: [{frequency_Hz: 80, mass_share_rel: 0.1}]
uncertainty: {motor_share_rel: 0.1}
)"),
                                      "");
  EXPECT_DOUBLE_EQ(a.motor_share, 0.3);
}

TEST(LooseAxis, TwoInertiasSeenAtTheMotor) {
  const StatedAxis a = ReadStatedAxis(WriteTestFile("model.yaml", R"(
motor_inertia_kgm2: 5e-5
load_inertia_kgm2: 4e-5
stiffness_Nm_rad: 20
damping_Nms_rad: 1e-3
friction: {acts_on: motor, Fc_plus_Nm: 0.03, Fc_minus_Nm: 0.03, sigma2_Nms_rad: 3e-4}
)"),
                                      "");
  EXPECT_TRUE(a.two_inertia);
  EXPECT_FALSE(a.friction_on_load);
  EXPECT_DOUBLE_EQ(a.motor_inertia, 5e-5);
  EXPECT_DOUBLE_EQ(a.load_inertia, 4e-5);
}

TEST(LooseAxis, StrictAboutKeysAndWhatFitsTogether) {
  const std::string friction =
      "friction: {acts_on: motor, Fc_plus_Nm: 1, Fc_minus_Nm: 1, sigma2_Nms_rad: 1}\n";
  EXPECT_EQ(Error("motor_inertia_kgm2: 1e-4\n" + friction), "");
  EXPECT_NE(Error("motor_inertia: 1e-4\n" + friction).find("motor_inertia_kgm2"), std::string::npos);
  EXPECT_NE(Error(friction).find("motor_inertia_kgm2: missing"), std::string::npos);
  EXPECT_NE(Error("mass_kg: 3\nmotor_inertia_kgm2: 1e-4\n" + friction).find("found on a linear axis"),
            std::string::npos);
  EXPECT_NE(Error("motor_inertia_kgm2: 1e-4\nfriction: {Fc_plus_N: 1, Fc_minus_N: 1, sigma2_Ns_m: 1}\n")
                .find("lead_mm: missing"),
            std::string::npos);
  EXPECT_NE(Error("motor_inertia_kgm2: 1e-4\nuncertainty: {foo: 0.1}\n" + friction).find("no parameter"),
            std::string::npos);
  EXPECT_NE(
      Error("motor_inertia_kgm2: 1e-4\nstiffness_Nm_rad: 4\n" + friction).find("a load behind the stiffness"),
      std::string::npos);
}

}  // namespace
}  // namespace contour::diagnosis
