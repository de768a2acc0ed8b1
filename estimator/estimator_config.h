#pragma once

#include "core/visit.h"

namespace contour {

/// Tuning of the estimator of one axis (`estimator:`; every key optional). Noise values are standard
/// deviations of what one millisecond adds; other cycle times scale with the square root of the period.
/// What each does and why it has its value: docs/estimator.md.
struct EstimatorConfig {
  double position_noise_um = 1.5e-5;
  double velocity_noise_mm_s = 0.003;
  double timing_noise = 0.02;
  double bristle_noise_rel = 0.012;
  double level_noise_rel = 0.00025;
  double four_state_level_noise_N = 0.075;
  double disturbance_noise_mm_s2 = 0.9;
  double log_sigma0_noise = 0.0003;
  double measurement_noise_um = 0.003;
  double disturbance_decay_ms = 200.0;
  double motion_gate_mm_s = 2.0;
  double rest_noise = 0.03;
  double log_sigma0_range = 1.5;
  double level_range = 2.0;
  double innovation_gate_sigma = 12.0;
  double innovation_gate_um = 20.0;
  double observer_bandwidth_Hz = 60.0;
  double disturbance_observer_bandwidth_Hz = 60.0;
  double ripple_rate = 0.1;
  double stribeck_rate = 0.3;
  double mass_rate = 0.001;
  double delay_rate = 0.001;
  double cogging_rate = 0.05;
  double viscous_rate = 0.001;
  double level_error = 0.05;
  double lasting_force = 0.3;
  double level_asymmetry = 0.3;
  double initial_level_std = 0.2;
  double initial_log_sigma0_std = 0.5;
  double mass_std = 0.05;
  double stiffness_std = 0.1;
  bool adapt = true;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("position_noise_um", position_noise_um, kNotNegative, "process noise of the position");
    v.Optional("velocity_noise_mm_s", velocity_noise_mm_s, kNotNegative, "process noise of the velocity");
    v.Optional("timing_noise", timing_noise, kNotNegative,
               "process noise of the force, as a share of the change of torque from one cycle to the next");
    v.Optional("bristle_noise_rel", bristle_noise_rel, kNotNegative,
               "process noise of the bristle force, as a share of the axis's Coulomb friction");
    v.Optional("level_noise_rel", level_noise_rel, kNotNegative, "the same of the friction levels");
    v.Optional("four_state_level_noise_N", four_state_level_noise_N, kNotNegative,
               "process noise of the one friction level of the four-state filter");
    v.Optional("disturbance_noise_mm_s2", disturbance_noise_mm_s2, kNotNegative,
               "process noise of the leaky disturbance, by the acceleration that it gives the axis");
    v.Optional("log_sigma0_noise", log_sigma0_noise, kNotNegative, "process noise of ln sigma0");
    v.Optional("measurement_noise_um", measurement_noise_um, kPositive,
               "position noise, at least the encoder's own step / sqrt(12)");
    v.Optional("disturbance_decay_ms", disturbance_decay_ms, kPositive, "time constant of the disturbance");
    v.Optional("motion_gate_mm_s", motion_gate_mm_s, kPositive,
               "speed from which the parameters take their full process noise");
    v.Optional("rest_noise", rest_noise, Range{0.0, 1.0},
               "share of the bristle's process noise while the commanded velocity is zero");
    v.Optional("log_sigma0_range", log_sigma0_range, kPositive, "bound of |ln(sigma0 / commissioned)|");
    v.Optional("level_range", level_range, Range{1.01, 100.0},
               "friction levels stay within this factor of their commissioned value");
    v.Optional("innovation_gate_sigma", innovation_gate_sigma, Range{3.0, 1e6},
               "a measurement further off than this many standard deviations, and");
    v.Optional("innovation_gate_um", innovation_gate_um, kPositive, "further off than this, is not believed");
    v.Optional("observer_bandwidth_Hz", observer_bandwidth_Hz, Range{1.0, 400.0},
               "bandwidth of the kinematic observer");
    v.Optional("disturbance_observer_bandwidth_Hz", disturbance_observer_bandwidth_Hz, Range{1.0, 400.0},
               "bandwidth of the disturbance observer");
    v.Optional("ripple_rate", ripple_rate, Range{0.0, 1.0},
               "share of the error that the per-turn ripple of the friction level learns per radian of the "
               "screw; 0 none");
    v.Optional(
        "stribeck_rate", stribeck_rate, Range{0.0, 1.0},
        "share of the error that the low-speed rise of the friction level learns per millisecond; 0 none");
    v.Optional("mass_rate", mass_rate, Range{0.0, 1.0},
               "share of the error that the correction of the moving mass learns per millisecond at 1 m/s^2, "
               "once it has learnt the most; 0 none");
    v.Optional(
        "delay_rate", delay_rate, Range{0.0, 1.0},
        "the same of the drive's delay, per millisecond in which the torque changes by 100 N / R; 0 none");
    v.Optional(
        "cogging_rate", cogging_rate, Range{0.0, 1.0},
        "share of the error that the map of forces by the screw's angle learns at least per visit of a "
        "millisecond; 0 none");
    v.Optional(
        "level_error", level_error, Range{0.0, 1.0},
        "share of the friction level up to which a disturbance turns round at a reversal as friction does");
    v.Optional(
        "lasting_force", lasting_force, kPositive,
        "share of the friction level beyond which a disturbance is an outside force that does not fade");
    v.Optional("level_asymmetry", level_asymmetry, kPositive,
               "share of the friction level by which the levels of the two directions may differ more than "
               "commissioned; what is beyond is an outside force");
    v.Optional("viscous_rate", viscous_rate, Range{0.0, 1.0},
               "share of the error that the correction of viscous friction learns per millisecond; 0 none");
    v.Optional("initial_level_std", initial_level_std, Range{0.0, 2.0},
               "relative uncertainty of the commissioned friction levels");
    v.Optional("initial_log_sigma0_std", initial_log_sigma0_std, Range{0.0, 3.0},
               "uncertainty of the logarithm of the commissioned bristle stiffness");
    v.Optional("mass_std", mass_std, Range{0.0, 1.0},
               "relative uncertainty of the moving mass: in the band of the friction estimate and, in csp, "
               "in the process noise of the velocity");
    v.Optional(
        "stiffness_std", stiffness_std, Range{0.0, 1.0},
        "relative uncertainty of the screw's stiffness where the model states none; 0: reversals do not "
        "correct the stiffness");
    v.Optional("adapt", adapt, kAny, "false: friction levels and stiffness keep their commissioned values");
  }
};

}  // namespace contour
