#include "tools/improve/fitted_model.h"

#include <gtest/gtest.h>

#include "config/load_machine.h"

namespace contour::improve {
namespace {

class FittedModelTest : public ::testing::Test {
 protected:
  ModelConfig model_ = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml").axes.at("x").model;
  diagnosis::Diagnosis found_;
};

TEST_F(FittedModelTest, NumbersChangeByTheFactorThatTheFitHas) {
  found_.base = {{"Fc", 0.03, 0.033, 1e-4}, {"load_inertia", 6e-6, 3e-6, 1e-7}};
  const ModelConfig fitted = FittedModel(model_, found_, 20.0);
  EXPECT_NEAR(fitted.friction.Fc_plus_N, 1.1 * model_.friction.Fc_plus_N, 1e-9);
  EXPECT_NEAR(fitted.friction.Fc_minus_N, 1.1 * model_.friction.Fc_minus_N, 1e-9);
  EXPECT_NEAR(fitted.mechanics.table_mass_kg, 0.5 * model_.mechanics.table_mass_kg, 1e-9);
  EXPECT_EQ(fitted.friction.vs_mm_s, model_.friction.vs_mm_s);
}

TEST_F(FittedModelTest, AStiffnessThatTheRecordDoesNotShowStays) {
  model_.uncertainty["screw_stiffness_N_um"] = 0.1;
  found_.base = {{"stiffness", 100.0, 115.0, 9.0}};
  EXPECT_EQ(FittedModel(model_, found_, 20.0).mechanics.screw_stiffness_N_um,
            model_.mechanics.screw_stiffness_N_um);
  found_.base = {{"stiffness", 100.0, 115.0, 2.0}};
  EXPECT_NEAR(FittedModel(model_, found_, 20.0).mechanics.screw_stiffness_N_um,
              1.15 * model_.mechanics.screw_stiffness_N_um, 1e-9);
}

}  // namespace
}  // namespace contour::improve
