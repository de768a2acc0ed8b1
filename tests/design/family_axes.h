#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "config/loop_axis.h"

namespace contour {

/// A loop for tests that is tuned for none of the axes below.
inline constexpr LoopTuning kTuning{.regulator_Hz = 9.0,
                                    .windup_weight = 0.2,
                                    .velocity_weight = 0.35,
                                    .disturbance_Hz = 150.0,
                                    .motor_force_Hz = 400.0,
                                    .table_force_Hz = 60.0,
                                    .notch_ratio = 0.7,
                                    .notch_pole_damping = 0.7,
                                    .notch_zero_damping = 0.2};

/// A family of feed axes from a light ball-screw table to a belt, with one drive and a mode of 3 % damping.
struct FamilyAxis {
  std::string name;
  double table_kg, motor_kg, stiffness_N_um, friction_N, rated_N;
};

inline const std::vector<FamilyAxis> kFamily{
    {"base", 10, 79, 40, 45, 800},  {"t20", 20, 79, 40, 45, 800},      {"t30", 30, 79, 40, 45, 800},
    {"t50", 50, 79, 40, 45, 800},   {"m100", 100, 316, 60, 150, 3000}, {"m300", 300, 1184, 100, 300, 6300},
    {"soft", 60, 79, 15, 80, 1250}, {"belt", 10, 1.23, 1, 15, 100}};

inline LoopAxis AxisOf(const FamilyAxis& f, bool scale = false) {
  LoopAxis a;
  const double reduced_kg = f.motor_kg * f.table_kg / (f.motor_kg + f.table_kg);
  const double stiffness_N_m = 1e6 * f.stiffness_N_um;
  const double share = f.friction_N / 45.0;
  a.axis = {.motor_mass_kg = f.motor_kg,
            .table_mass_kg = f.table_kg,
            .stiffness_N_m = stiffness_N_m,
            .damping_Ns_m = 2.0 * 0.03 * std::sqrt(stiffness_N_m * reduced_kg),
            .viscous_Ns_m = 500.0 * share,
            .lag_s = 0.2e-3};
  a.friction = {.Fs_plus_N = 1.1 * f.friction_N,
                .Fs_minus_N = 1.1 * f.friction_N,
                .Fc_plus_N = 0.87 * f.friction_N,
                .Fc_minus_N = 0.87 * f.friction_N,
                .vs_m_s = 2e-3,
                .stribeck_exponent = 1.0,
                .sigma0_N_m = f.friction_N / 9e-6,
                .sigma1_Ns_m = 3000.0 * share,
                .sigma1_decay_m_s = 2e-3,
                .sigma2_Ns_m = 500.0 * share};
  a.rated_force_N = f.rated_N;
  a.encoder_step_m = 5e-3 / 1048576.0;
  if (scale) a.scale_step_m = 5e-9;
  a.stiffness_std = a.motor_mass_std = a.table_mass_std = a.limits.uncertainty;
  return a;
}

inline LoopAxis AxisOf(const std::string& name, bool scale = false) {
  for (const FamilyAxis& f : kFamily)
    if (f.name == name) return AxisOf(f, scale);
  return {};
}

}  // namespace contour
