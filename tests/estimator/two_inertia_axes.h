#pragma once

#include <array>
#include <cmath>

#include "core/two_inertia_axis.h"
#include "core/two_inertia_loop.h"
#include "estimator/two_inertia_estimator.h"
#include "tests/estimator/screw_axis.h"

// Axes with tables from 10 to 300 kg for tests of the two-inertia estimator and loop.
namespace contour::test {

struct FamilyAxis {
  const char* name;
  double table_mass_kg, motor_mass_kg, stiffness_N_m, friction_N, rated_N;
};

inline constexpr std::array<FamilyAxis, 5> kFamily{{{"base", 10, 79, 40e6, 45, 800},
                                                    {"t30", 30, 79, 40e6, 45, 800},
                                                    {"t50", 50, 79, 40e6, 45, 800},
                                                    {"m300", 300, 1184, 100e6, 300, 6300},
                                                    {"soft", 60, 79, 15e6, 80, 1250}}};

/// A loop that holds every one of them; no axis's own.
inline constexpr LoopTuning kSteadyTuning{.regulator_Hz = 20.0,
                                          .windup_weight = 0.4,
                                          .velocity_weight = 0.18,
                                          .disturbance_Hz = 200.0,
                                          .motor_force_Hz = 400.0,
                                          .table_force_Hz = 400.0,
                                          .notch_ratio = 0.77,
                                          .notch_pole_damping = 0.7,
                                          .notch_zero_damping = 0.3};

/// The truth: two inertias, LuGre.
inline ScrewAxis Truth(const FamilyAxis& a) {
  ScrewAxis axis;
  const double part = a.friction_N / 45.0;
  axis.motor_mass_kg = a.motor_mass_kg;
  axis.table_mass_kg = a.table_mass_kg;
  axis.stiffness_N_m = a.stiffness_N_m;
  const double mode = std::sqrt(a.stiffness_N_m * (1.0 / a.motor_mass_kg + 1.0 / a.table_mass_kg));
  axis.damping_Ns_m = 2.0 * 0.03 * a.stiffness_N_m / mode;
  for (double& level : axis.Fs) level *= part;
  for (double& level : axis.Fc) level *= part;
  axis.sigma0_N_m *= part;
  axis.sigma1_Ns_m *= part;
  axis.sigma2_Ns_m *= part;
  return axis;
}

/// How far the model is from it.
struct ModelError {
  double masses = 1.05, stiffness = 0.98, damping = 0.5, friction = 0.8, sigma0 = 0.8;
};

inline TwoInertiaEstimator::Setup EstimatorOf(const FamilyAxis& a, double period_s, const ModelError& error) {
  const ScrewAxis truth = Truth(a);
  TwoInertiaEstimator::Setup s;
  Mechanics m;
  m.radius_m_rad = truth.lead_m / 2.0 / std::numbers::pi;
  m.table_mass_kg = error.masses * a.table_mass_kg;
  m.mass_kg = error.masses * a.motor_mass_kg + m.table_mass_kg;
  m.stiffness_N_m = error.stiffness * a.stiffness_N_m;
  m.damping_Ns_m = error.damping * truth.damping_Ns_m;
  FrictionConfig f;
  f.Fs_plus_N = error.friction * truth.Fs[0];
  f.Fs_minus_N = error.friction * truth.Fs[1];
  f.Fc_plus_N = error.friction * truth.Fc[0];
  f.Fc_minus_N = error.friction * truth.Fc[1];
  f.vs_mm_s = 1e3 * truth.vs_m_s;
  f.sigma0_N_m = error.sigma0 * truth.sigma0_N_m;
  f.sigma1_Ns_m = error.friction * truth.sigma1_Ns_m;
  f.sigma1_decay_mm_s = 1e3 * truth.vd_m_s;
  f.sigma2_Ns_m = error.friction * truth.sigma2_Ns_m;
  s.filter = AxisEstimator::SetupOf(m, f, {}, period_s, truth.lag_s, truth.lead_m / 1048576);
  s.axis = ToTwoInertiaAxis(m, f.sigma2_Ns_m, truth.lag_s, 1);
  s.loop = DesignLoop(s.axis, kSteadyTuning, period_s, false);
  s.external_force_N = 0.25 * a.rated_N;  // as where no machine file says anything
  s.position_min_m = -0.2;
  s.position_max_m = 0.2;
  return s;
}

inline TwoInertiaObserver::Setup ObserverOf(const FamilyAxis& a, double period_s) {
  const TwoInertiaEstimator::Setup s = EstimatorOf(a, period_s, {1, 1, 1, 1, 1});
  return {s.axis,
          s.loop,
          period_s,
          s.filter.measurement_std_m,
          {s.filter.config.innovation_gate_sigma, s.filter.config.innovation_gate_um * 1e-6},
          s.filter.Sudden_m()};
}

}  // namespace contour::test
