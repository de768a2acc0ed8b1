#pragma once

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "control/control_config.h"
#include "control/motion_thresholds.h"
#include "core/mechanics.h"

namespace contour {

/// Friction as far as the monitor needs it, at the table.
struct MonitoredFriction {
  double Fs_N = 0.0;  ///< the larger of both directions
  double Fc_N = 0.0;  ///< the smaller of both directions
  double vs_m_s = 0.0;
  double sigma0_N_m = 0.0;
  double sigma2_Ns_m = 0.0;
};

/// Of a Friction of the estimator, which is a neighbour of this floor.
template <class Friction>
constexpr MonitoredFriction ToMonitored(const Friction& f) noexcept {
  return {std::max(f.Fs_plus_N, f.Fs_minus_N), std::min(f.Fc_plus_N, f.Fc_minus_N), f.vs_m_s, f.sigma0_N_m,
          f.sigma2_Ns_m};
}

/// Drive and encoder as far as the monitor needs them.
struct MonitoredDrive {
  double rated_torque_Nm = 0.0;
  double counts_per_rev = 0.0;
  std::uint32_t delay_cycles = 1;
  std::uint32_t bitrate_bit_s = 1'000'000;
  bool in_cascade = false;
};

// A SYNC waits for the frame that is on the wire, at most one of 8 bytes with all its stuff bits (CiA 301
// leaves it the highest priority but for NMT).
inline constexpr double kLongestFrame_bits = 135.0;

// An axis that slides is at some multiple of its Stribeck speed.
inline constexpr double kSlideOverStribeck = 5.0;
// Of rated force, where the machine file does not state what may push besides friction.
inline constexpr double kExternalShare = 0.25;

/// Largest force on the table besides friction.
constexpr double ExternalForce_N(const AxisLimitsSi& limits, double rated_force_N) noexcept {
  return limits.external_force_N > 0.0 ? limits.external_force_N : kExternalShare * rated_force_N;
}

constexpr MonitoredAxis ToMonitored(const Mechanics& m, const MonitoredFriction& friction,
                                    const MonitoredDrive& drive, const AxisLimitsSi& limits,
                                    double loop_Hz) noexcept {
  MonitoredAxis a;
  a.motor_mass_kg = m.mass_kg - m.table_mass_kg;
  a.table_mass_kg = m.table_mass_kg;
  a.stiffness_N_m = m.stiffness_N_m;
  a.Fs_N = friction.Fs_N;
  a.Fc_N = friction.Fc_N;
  a.sigma0_N_m = friction.sigma0_N_m;
  a.sigma2_Ns_m = friction.sigma2_Ns_m;
  a.slide_m_s = kSlideOverStribeck * friction.vs_m_s;
  a.force_limit_N = limits.force_N;
  a.rated_force_N = drive.rated_torque_Nm / m.radius_m_rad;
  a.external_force_N = ExternalForce_N(limits, a.rated_force_N);
  a.count_m = 2.0 * std::numbers::pi * m.radius_m_rad / drive.counts_per_rev;
  a.loop_Hz = loop_Hz;
  a.delay_cycles = drive.delay_cycles;
  a.in_cascade = drive.in_cascade;
  a.sample_jitter_s = kLongestFrame_bits / drive.bitrate_bit_s;
  return a;
}

}  // namespace contour
