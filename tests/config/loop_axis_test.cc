#include "config/loop_axis.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

AxisConfig Axis() {
  AxisConfig a;
  a.drive.rated_torque_Nm = 0.637;
  a.drive.encoder_counts_per_rev = 1000;
  a.drive.delay_cycles = 2;
  a.drive.lag_ms = 0.3;
  a.model.mechanics = {.lead_mm = 5.0,
                       .motor_inertia_kgm2 = 5e-5,
                       .table_mass_kg = 10.0,
                       .screw_stiffness_N_um = 40.0,
                       .screw_damping_Ns_m = 1100.0};
  a.model.friction.sigma2_Ns_m = 500.0;
  a.model.friction.vs_mm_s = 2.0;
  return a;
}

TEST(LoopAxisOf, IsTheAxisAtTheTableInSi) {
  const LoopAxis a = LoopAxisOf(Axis());
  EXPECT_NEAR(a.axis.motor_mass_kg, 79.0, 0.1);
  EXPECT_NEAR(a.axis.table_mass_kg, 10.0, 1e-9);
  EXPECT_DOUBLE_EQ(a.axis.stiffness_N_m, 40e6);
  EXPECT_DOUBLE_EQ(a.axis.viscous_Ns_m, 500.0);
  EXPECT_DOUBLE_EQ(a.axis.lag_s, 0.3e-3);
  EXPECT_EQ(a.axis.delay_cycles, 2);
  EXPECT_NEAR(a.rated_force_N, 800.0, 1.0);
  EXPECT_DOUBLE_EQ(a.encoder_step_m, 5e-6);
  EXPECT_FALSE(a.scale_step_m);
}

TEST(LoopAxisOf, TakesUncertaintiesFromTheModelAndTheRestFromTheLimits) {
  AxisConfig axis = Axis();
  axis.model.uncertainty = {{"screw_stiffness_N_um", 0.2}, {"table_mass_kg", 0.001}};
  const LoopAxis a = LoopAxisOf(axis);
  EXPECT_DOUBLE_EQ(a.stiffness_std, 0.2);
  EXPECT_DOUBLE_EQ(a.table_mass_std, axis.loop_limits.smallest_uncertainty);
  EXPECT_DOUBLE_EQ(a.motor_mass_std, axis.loop_limits.uncertainty);
}

TEST(LoopAxisOf, KnowsTheScaleAndWhatDiagnosisAdded) {
  AxisConfig axis = Axis();
  axis.drive.linear_scale = LinearScaleConfig{.counts_per_mm = 200000.0};
  axis.model.extensions.input_delay = InputDelayExtension{.delay_us = 60.0};
  axis.model.extensions.current_lag = CurrentLagExtension{.time_constant_us = 50.0};
  EXPECT_FALSE(ScaleLoopAxisOf(Axis()));
  EXPECT_FALSE(LoopAxisOf(axis).scale_step_m);
  ASSERT_TRUE(ScaleLoopAxisOf(axis));
  const LoopAxis a = *ScaleLoopAxisOf(axis);
  EXPECT_DOUBLE_EQ(a.scale_step_m.value_or(0.0), 5e-9);
  EXPECT_NEAR(a.axis.dead_time_s, 60e-6, 1e-12);
  EXPECT_NEAR(a.axis.lag_s, 0.35e-3, 1e-12);
}

// A loop that a check passes must be the one that runs.
TEST(TwoInertiaAxisOf, IsTheAxisOfTheJudgedLoop) {
  AxisConfig axis = Axis();
  axis.model.extensions.input_delay = InputDelayExtension{.delay_us = 60.0};
  axis.model.extensions.current_lag = CurrentLagExtension{.time_constant_us = 50.0};
  EXPECT_EQ(TwoInertiaAxisOf(axis), LoopAxisOf(axis).axis);
  EXPECT_NEAR(TwoInertiaAxisOf(axis).dead_time_s, 60e-6, 1e-12);
}

TEST(WindUpUnderForceStep, IsForceOverStiffnessOfTheWeakestScrew) {
  const LoopAxis stated = LoopAxisOf(Axis());
  const double one_m = stated.limits.force_step * stated.rated_force_N / stated.axis.stiffness_N_m;
  EXPECT_DOUBLE_EQ(WindUpUnderForceStep_m(Axis()), one_m);
  MachineConfig machine;
  machine.axes["x"] = Axis();
  machine.axes["y"] = Axis();
  machine.axes["y"].model.mechanics.screw_stiffness_N_um /= 2.0;
  EXPECT_NEAR(WindUpUnderForceStep_m(machine), 2.0 * one_m, 1e-12);
}

}  // namespace
}  // namespace contour
