#include "analysis/identification/table_axis.h"

#include <gtest/gtest.h>

#include <numbers>

#include "analysis/axis_model/read_stated_axis.h"
#include "config/load_machine.h"
#include "tests/analysis/identification/generated_axis.h"
#include "tests/config/test_files.h"

namespace contour::identify {
namespace {

const MachineConfig& Machine() {
  static const MachineConfig machine = LoadMachine(ExampleMachine("xy_emulated.yaml"));
  return machine;
}

TEST(TableAxis, IsTheStatedAxisInTableUnits) {
  const TableAxis axis = FromStated(diagnosis::ToStatedAxis(Machine(), "x"));
  const ModelConfig& model = Machine().axes.at("x").model;
  const double r = model.mechanics.lead_mm * 1e-3 / (2.0 * std::numbers::pi);
  EXPECT_TRUE(axis.two_inertia && axis.friction_on_load);
  EXPECT_NEAR(axis.radius_m_rad, r, 1e-12);
  EXPECT_NEAR(axis.turn_m, model.mechanics.lead_mm * 1e-3, 1e-12);
  EXPECT_NEAR(axis.motor_inertia, model.mechanics.motor_inertia_kgm2 / (r * r), 1e-9);
  EXPECT_NEAR(axis.load_inertia, model.mechanics.table_mass_kg, 1e-9);
  EXPECT_NEAR(axis.mass_kg(), axis.motor_inertia + axis.load_inertia, 1e-12);
  EXPECT_NEAR(axis.stiffness, model.mechanics.screw_stiffness_N_um * 1e6, 1e-3);
  EXPECT_NEAR(axis.friction.Fc_minus, model.friction.Fc_minus_N, 1e-9);
  EXPECT_NEAR(axis.friction.vs, model.friction.vs_mm_s * 1e-3, 1e-12);
  EXPECT_NEAR(axis.friction.s0, model.friction.sigma0_N_m, 1e-3);
}

TEST(TableAxis, GoesBackIntoTheModelItCameFrom) {
  const ModelConfig& before = Machine().axes.at("x").model;
  const TableAxis axis = FromStated(diagnosis::ToStatedAxis(Machine(), "x"));
  ModelConfig after = before;
  after.mechanics.table_mass_kg = after.friction.Fs_plus_N = after.friction.sigma1_Ns_m = -1.0;
  IntoConfig(axis, after);
  EXPECT_NEAR(after.mechanics.table_mass_kg, before.mechanics.table_mass_kg, 1e-9);
  EXPECT_NEAR(after.mechanics.motor_inertia_kgm2, before.mechanics.motor_inertia_kgm2, 1e-15);
  EXPECT_NEAR(after.friction.Fs_plus_N, before.friction.Fs_plus_N, 1e-9);
  EXPECT_NEAR(after.friction.sigma1_Ns_m, before.friction.sigma1_Ns_m, 1e-9);
  EXPECT_NEAR(after.friction.sigma1_decay_mm_s, before.friction.sigma1_decay_mm_s, 1e-9);
}

TEST(TableAxis, CoggingSwingingPartsAndFrictionOnTheMotorGoIntoTheModel) {
  TableAxis axis = test::Exactly(test::PlainAxis());
  axis.cogging[0] = {12.0, 0.0, 4.0};
  axis.cogging[1] = {18.0, 2.0, 0.0};
  axis.motor_friction_share = 0.3;
  axis.side = {0.12, 186.0, 0.02};
  ModelConfig model;
  model.friction.acts_on = FrictionSide::kTable;
  IntoConfig(axis, model);
  ASSERT_TRUE(model.extensions.cogging);
  EXPECT_NEAR(model.extensions.cogging->amplitude_Nm, 4.0 * axis.radius_m_rad, 1e-12);
  EXPECT_NEAR(model.extensions.cogging->phase_rad, 0.0, 1e-12);
  ASSERT_EQ(model.extensions.cogging->further.size(), 1U);
  EXPECT_NEAR(model.extensions.cogging->further[0].phase_rad, 0.5 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(model.friction.motor_share_rel, 0.3, 1e-12);
  ASSERT_EQ(model.side_modes.size(), 1U);
  EXPECT_NEAR(model.side_modes[0].frequency_Hz, 186.0, 1e-9);
  EXPECT_NEAR(model.side_modes[0].mass_share_rel, 0.12, 1e-9);
}

TEST(TableAxis, FrictionStatedAtTheMotorIsWrittenAtTheMotor) {
  TableAxis axis;
  axis.radius_m_rad = 1e-3;
  axis.friction.Fc_plus = 40.0;
  axis.friction.vs = 2e-3;
  axis.friction.s2 = 500.0;
  ModelConfig model;
  model.friction.acts_on = FrictionSide::kMotor;
  IntoConfig(axis, model);
  EXPECT_DOUBLE_EQ(model.friction.Fc_plus_Nm, 0.04);
  EXPECT_DOUBLE_EQ(model.friction.vs_rad_s, 2.0);
  EXPECT_DOUBLE_EQ(model.friction.sigma2_Nms_rad, 5e-4);
}

}  // namespace
}  // namespace contour::identify
