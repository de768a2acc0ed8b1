// An axis on which one effect alone shows.
#pragma once

#include <numbers>

#include "tests/plant_emulator/drive_harness.h"
#include "tools/plant_emulator/axis_plant.h"
#include "tools/plant_emulator/effects_config.h"

namespace contour::plant {

inline constexpr double kRadius_m_rad = 5e-3 / (2.0 * std::numbers::pi);
inline constexpr double kTurn_m = 5e-3;

/// Constant friction of 40 N in both directions, nothing that varies; or none at all.
inline EmulatedAxisConfig Plain(double friction_N = 40.0) {
  EmulatedAxisConfig c = test::NominalAxis();
  auto& f = c.friction;
  f.Fs_plus_N = f.Fs_minus_N = f.Fc_plus_N = f.Fc_minus_N = friction_N;
  f.sigma1_Ns_m = 0.0;
  f.sigma2_Ns_m = 0.0;
  f.position_amplitude_rel = f.ripple_amplitude_rel = 0.0;
  c.start_variation_mm = 0.0;
  return c;
}
inline AxisPlant Make(const EmulatedAxisConfig& c) {
  AxisParameters p = MakeAxisParameters(c, test::Place("x", 1), 1, 0.0, 0);
  p.start_bristle_N = 0.0;
  return AxisPlant(p);
}

/// Too heavy for friction to slow it within a step.
inline EmulatedAxisConfig Heavy(EmulatedAxisConfig c) {
  c.table_mass_kg = 1e9;
  c.motor_inertia_kgm2 = 1e3;
  return c;
}

/// Friction in steady sliding at a place and speed.
inline double Sliding_N(const EmulatedAxisConfig& light, double x_m, double v_m_s) {
  const EmulatedAxisConfig c = Heavy(light);
  AxisPlant plant = Make(c);
  for (int i = 0; i < 4000; ++i) {
    plant.SetState(x_m, v_m_s, x_m, v_m_s);
    plant.Step(5e-5, 0.0);
  }
  plant.SetState(x_m, v_m_s, x_m, v_m_s);
  return plant.friction_N();
}

/// Force on the whole axis without friction: change of momentum over a very short step.
inline double Push_N(const EmulatedAxisConfig& c, double x_m, double v_m_s, double torque_Nm,
                     double windup_m = 0.0) {
  AxisPlant plant = Make(c);
  plant.SetState(x_m + windup_m, v_m_s, x_m, v_m_s);
  const double h = 1e-7;
  plant.Step(h, torque_Nm);
  const double motor_kg = c.motor_inertia_kgm2 / (kRadius_m_rad * kRadius_m_rad);
  return (motor_kg * (plant.motor_velocity_m_s() - v_m_s) +
          c.table_mass_kg * (plant.table_velocity_m_s() - v_m_s)) /
         h;
}

}  // namespace contour::plant
