#include "tools/improve/fitted_model.h"

#include <gtest/gtest.h>

#include "analysis/axis_model/read_stated_axis.h"
#include "config/load_machine.h"

namespace contour::improve {
namespace {

class FittedModelTest : public ::testing::Test {
 protected:
  FittedModelTest() { model_.uncertainty["screw_stiffness_N_um"] = 0.1; }
  [[nodiscard]] diagnosis::StatedAxis Stated() const {
    MachineConfig machine = machine_;
    machine.axes.at("x").model = model_;
    return diagnosis::ToStatedAxis(machine, "x");
  }
  [[nodiscard]] std::vector<ModelConfig> Models() const {
    return FittedModels(model_, Stated(), found_, 20.0);
  }

  const MachineConfig machine_ = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
  ModelConfig model_ = machine_.axes.at("x").model;
  diagnosis::Diagnosis found_;
};

TEST_F(FittedModelTest, ARecordThatSaysNothingLeadsToNoModel) {
  EXPECT_TRUE(Models().empty());
  found_.fitted = Stated();
  EXPECT_TRUE(Models().empty());
}

TEST_F(FittedModelTest, NumbersAreThoseOfTheFit) {
  found_.fitted = Stated();
  found_.fitted->friction.Fc_plus *= 1.1;
  found_.fitted->load_inertia *= 0.5;
  const auto models = Models();
  ASSERT_EQ(models.size(), 1u);
  EXPECT_NEAR(models[0].friction.Fc_plus_N, 1.1 * model_.friction.Fc_plus_N, 1e-3);
  EXPECT_NEAR(models[0].mechanics.table_mass_kg, 0.5 * model_.mechanics.table_mass_kg, 1e-3);
  EXPECT_EQ(models[0].friction.vs_mm_s, model_.friction.vs_mm_s);
  EXPECT_EQ(models[0].uncertainty, model_.uncertainty);
}

TEST_F(FittedModelTest, WhereFreeRunsDecidedOneStepErrorsGetTheirTurnToo) {
  found_.fitted = Stated();
  found_.fitted->friction.s0 *= 0.8;
  found_.base = {{"s0", 2.0, 2.1, 1e-3}, {"Fc", 0.03, 0.033, 1e-4}};
  const auto models = Models();
  ASSERT_EQ(models.size(), 2u);
  EXPECT_NEAR(models[0].friction.sigma0_N_m, 0.8 * model_.friction.sigma0_N_m, 10.0);
  EXPECT_NEAR(models[1].friction.sigma0_N_m, 1.05 * model_.friction.sigma0_N_m, 100.0);
  EXPECT_NEAR(models[1].friction.Fc_minus_N, 1.1 * model_.friction.Fc_minus_N, 1e-3);
}

TEST_F(FittedModelTest, AStiffnessThatTheRecordDoesNotShowStays) {
  found_.fitted = Stated();
  found_.fitted->stiffness *= 1.15;
  found_.fitted->friction.s2 *= 1.1;
  found_.fitted->sigma["stiffness"] = 0.09;
  ASSERT_EQ(Models().size(), 1u);
  EXPECT_EQ(Models()[0].mechanics.screw_stiffness_N_um, model_.mechanics.screw_stiffness_N_um);
  found_.fitted->sigma["stiffness"] = 0.02;
  EXPECT_NEAR(Models()[0].mechanics.screw_stiffness_N_um, 1.15 * model_.mechanics.screw_stiffness_N_um, 1e-2);
}

TEST_F(FittedModelTest, FreeRunsSayNothingOfTheScrew) {
  found_.fitted = Stated();
  found_.fitted->stiffness *= 0.5;
  found_.fitted->friction.s2 *= 1.1;
  found_.fitted->sigma["stiffness"] = 1e-4;
  found_.base = {{"stiffness", 100.0, 98.0, 0.3}};
  for (const ModelConfig& m : Models())
    EXPECT_NEAR(m.mechanics.screw_stiffness_N_um, 0.98 * model_.mechanics.screw_stiffness_N_um, 1e-2);
}

TEST_F(FittedModelTest, BreakAwayFrictionIsNeverBelowCoulombFriction) {
  found_.fitted = Stated();
  found_.fitted->friction.Fc_plus = 1.05 * found_.fitted->friction.Fs_plus;
  ASSERT_EQ(Models().size(), 1u);
  EXPECT_GE(Models()[0].friction.Fs_plus_N, Models()[0].friction.Fc_plus_N);
}

TEST_F(FittedModelTest, NumbersThatExtensionsStoodForAreNotCountedTwice) {
  model_.extensions.asymmetric_coulomb = AsymmetricCoulombExtension{0.2};
  found_.fitted = Stated();
  const auto unchanged = Models();
  EXPECT_TRUE(unchanged.empty());
  found_.fitted->friction.s2 *= 1.1;
  ASSERT_EQ(Models().size(), 1u);
  EXPECT_FALSE(Models()[0].extensions.asymmetric_coulomb.has_value());
  EXPECT_NEAR(Models()[0].friction.Fc_plus_N, 1.1 * model_.friction.Fc_plus_N, 1e-2);
}

}  // namespace
}  // namespace contour::improve
