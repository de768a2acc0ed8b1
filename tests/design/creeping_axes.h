#pragma once

#include "tests/design/family_axes.h"

namespace contour {

/// Friction that falls by this from standstill to sliding, within a Stribeck velocity of 1.2 mm/s.
inline LoopAxis WithSlope(LoopAxis a, double sticks_N, double slides_N, double bends_m) {
  Friction& f = a.friction;
  f.Fs_plus_N = f.Fs_minus_N = sticks_N;
  f.Fc_plus_N = f.Fc_minus_N = slides_N;
  f.vs_m_s = f.sigma1_decay_m_s = 1.2e-3;
  f.sigma0_N_m = slides_N / bends_m;
  a.friction_std = 0.2;
  return a;
}

/// A stage of 8 kg in all whose friction is worth 1.5 m/s2: the slope at which it falls is quicker than a
/// loop over a bus of 1 kHz is on a screw of 115 Hz.
inline LoopAxis LightStage() {
  return WithSlope(AxisOf({"light stage", 5.5, 2.7, 0.89, 14.0, 70.0}), 15.3, 12.1, 11e-6);
}

/// A light stage behind soft bristles (1.1 N/um): held by them, what a loop adds up moves the table with a
/// time constant of more than a second.
inline LoopAxis SoftlyHeld() {
  LoopAxis a = WithSlope(AxisOf({"softly held", 7.85, 3.3, 2.6, 21.0, 108.0}), 23.7, 18.6, 16.8e-6);
  a.friction.vs_m_s = a.friction.sigma1_decay_m_s = 2.37e-3;
  a.axis.lag_s = 0.41e-3;
  a.encoder_step_m = 3.7e-3 / 1048576.0;
  return a;
}

/// A table of 5.4 times its motor on a screw of 56 Hz, lead 40 mm; friction of 156 N.
inline LoopAxis HeavyTable() {
  LoopAxis a = WithSlope(AxisOf({"heavy table", 420.0, 77.7, 7.99, 156.0, 1571.0}), 198.0, 156.0, 7.8e-6);
  a.friction.vs_m_s = a.friction.sigma1_decay_m_s = 2e-3;
  a.friction.sigma1_Ns_m = 12e3;
  a.friction.sigma2_Ns_m = a.axis.viscous_Ns_m = 2000.0;
  a.axis.damping_Ns_m = 989.0;
  a.encoder_step_m = 40e-3 / 1048576.0;
  a.most_force_N = 3691.0;
  a.motor_mass_std = a.table_mass_std = 0.05;
  a.stiffness_std = 0.1;
  return a;
}
/// What errs least on it over 200 ms of all that keeps the limits: it holds against a force, which it takes
/// up in seconds.
inline constexpr LoopTuning kHoldsOnly{14.7,  0.579, 0.064,  10.0, 892.0, 533.0,
                                       0.573, 0.169, 0.0343, 1.0,  5.0};

/// Held by bristles of 10 N/um, which swing at 46 Hz with 115 kg; a cycle of 4 ms is too slow to damp that.
inline constexpr double kSlowPeriod_s = 4e-3;
inline LoopAxis StiffTable() {
  LoopAxis a = WithSlope(AxisOf({"stiff table", 62.0, 53.0, 115.0, 46.0, 415.0}), 50.5, 39.8, 4e-6);
  a.friction.vs_m_s = a.friction.sigma1_decay_m_s = 3.9e-3;
  return a;
}

}  // namespace contour
