#include "analysis/axis_model/read_stated_axis.h"

#include <gtest/gtest.h>

#include <numbers>

#include "config/config_error.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

TEST(ReadStatedAxis, MachineFile) {
  const StatedAxis a = ReadStatedAxis(ExampleMachine("xy_emulated.yaml"), "x");
  const double r = 5e-3 / kTwoPi;
  EXPECT_EQ(a.axis, "x");
  EXPECT_TRUE(a.two_inertia);
  EXPECT_TRUE(a.friction_on_load);
  EXPECT_DOUBLE_EQ(a.motor_inertia, 4.65e-5);
  EXPECT_DOUBLE_EQ(a.load_inertia, r * r * 10.6);
  EXPECT_DOUBLE_EQ(a.stiffness, r * r * 44.5e6);
  EXPECT_DOUBLE_EQ(a.friction.Fc_plus, 36.5 * r);
  EXPECT_DOUBLE_EQ(a.friction.vs, 2.4e-3 / r);
  EXPECT_DOUBLE_EQ(a.friction.s0, 4.2e6 * r * r);
  EXPECT_DOUBLE_EQ(a.friction.s2, 440 * r * r);
  EXPECT_DOUBLE_EQ(a.delay_s, 1e-3);
  EXPECT_DOUBLE_EQ(a.lag_s, 0.2e-3);
  EXPECT_DOUBLE_EQ(a.command_step, 0.637e-3);
  EXPECT_DOUBLE_EQ(a.stroke_max_m, 0.2);
  EXPECT_DOUBLE_EQ(a.sigma.at("Fc"), 0.1);
  EXPECT_DOUBLE_EQ(a.sigma.at("inertia"), 0.05);
  EXPECT_DOUBLE_EQ(a.sigma.at("s0"), 0.2);
  EXPECT_THROW(ReadStatedAxis(ExampleMachine("xy_emulated.yaml"), ""), ConfigError);
}

TEST(ReadStatedAxis, ANumberOfTheFileMayBeOverridden) {
  const std::string file = ExampleMachine("xy_emulated.yaml");
  const StatedAxis a = ReadStatedAxis(file, "y", {"axes.y.model.motor_inertia_kgm2=4.9e-5"});
  EXPECT_DOUBLE_EQ(a.motor_inertia, 4.9e-5);
  EXPECT_NE(ReadStatedAxis(file, "y").motor_inertia, 4.9e-5);
}

TEST(ReadStatedAxis, AnAxisThatTheMachineHasNotIsRefusedByName) {
  try {
    ReadStatedAxis(ExampleMachine("xy_emulated.yaml"), "w");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("w"), std::string::npos) << e.what();
  }
}

// Before: "stiffness_N_m: unknown key, wrong unit: expected stiffness_N_m, in Nm/rad".
TEST(ReadStatedAxis, SaysWhatASpringIsCalledOnALinearAxis) {
  try {
    ReadStatedAxis(WriteTestFile("model.yaml",
                                 "mass_kg: 40\nload_mass_kg: 85\nstiffness_N_m: 2e7\ndamping_Nms_rad: 6\n"),
                   "");
    FAIL();
  } catch (const ConfigError& e) {
    const std::string said = e.what();
    EXPECT_NE(said.find("stiffness_N_m: found on a linear axis, expected screw_stiffness_N_um"),
              std::string::npos)
        << said;
    EXPECT_NE(said.find("damping_Nms_rad: found on a linear axis, expected screw_damping_Ns_m"),
              std::string::npos)
        << said;
  }
}

TEST(ReadStatedAxis, TellsMachineFilesFromModels) {
  EXPECT_TRUE(IsMachineFile(ExampleMachine("single_axis.yaml")));
  EXPECT_FALSE(IsMachineFile(WriteTestFile("model.yaml", "mass_kg: 95\n")));
}

}  // namespace
}  // namespace contour::diagnosis
