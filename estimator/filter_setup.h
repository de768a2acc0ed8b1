#pragma once

#include <algorithm>
#include <cmath>

#include "core/mechanics.h"
#include "estimator/estimator_config.h"
#include "estimator/friction_config.h"

namespace contour {

/// An axis's own numbers, which thresholds are shares of.
struct AxisScale {
  double friction_N = 39.0;          ///< Coulomb friction, mean of both directions
  double acceleration_m_s2 = 0.437;  ///< what it does to the whole mass
  double speed_m_s = 2.05e-3;        ///< Stribeck velocity
};

/// Process noise of one millisecond, for one axis.
struct AxisNoise {
  double velocity_m_s = 0.0;
  double bristle_N = 0.0;
  double level_N = 0.0;
  double four_state_level_N = 0.0;
  double disturbance_N = 0.0;
  double gate_m_s = 0.0;  ///< speed from which parameters take all of theirs
};

/// What every filter of an axis is built from.
struct FilterSetup {
  Mechanics mechanics;
  Friction friction;
  EstimatorConfig config;
  double period_s = 1e-3;
  double lag_s = 0.0;
  double measurement_std_m = 2e-8;  ///< position noise, quantisation included
  bool looks_ahead = true;  ///< FrictionAhead_N is wanted; not where friction is rolled along the reference
  bool reported_torque = false;  ///< torque as the drive tells it, at the samples, not as it was commanded

  [[nodiscard]] AxisScale Scale() const noexcept {
    const double friction_N = 0.5 * (friction.Fc_plus_N + friction.Fc_minus_N);
    return {friction_N, friction_N / mechanics.mass_kg, friction.vs_m_s};
  }

  [[nodiscard]] AxisNoise Noise() const noexcept {
    const AxisScale a = Scale();
    const EstimatorConfig& c = config;
    const double gate_m_s = c.motion_gate * a.speed_m_s;
    return {
        c.velocity_noise_mm_s ? 1e-3 * *c.velocity_noise_mm_s : c.velocity_noise * a.acceleration_m_s2 * 1e-3,
        c.bristle_noise_N.value_or(c.bristle_noise * a.friction_N),
        c.level_noise_N.value_or(c.level_noise * a.friction_N),
        c.four_state_level_noise_N.value_or(c.four_state_level_noise * a.friction_N),
        c.disturbance_noise_N.value_or(c.disturbance_noise * a.friction_N),
        c.motion_gate_mm_s ? 1e-3 * *c.motion_gate_mm_s : gate_m_s};
  }

  /// So far forces that no model knows take an axis from where it is expected, a T^2: half of it in this
  /// period, half because a filter has not made up for the one before. Friction that turns round, a force
  /// from outside, and what mass and torque are off by under the torque that acts. A single reading that is
  /// further off is no motion. `force_N`, `before_N`: of the drive in this period and the one before.
  [[nodiscard]] double Sudden_m(double force_N, double before_N) const noexcept {
    const double friction_N =
        std::max({friction.Fs_plus_N, friction.Fs_minus_N, friction.Fc_plus_N, friction.Fc_minus_N});
    const double pushed_N = config.mass_error * std::max(std::abs(force_N), std::abs(before_N));
    const double unknown_N = 2.0 * friction_N + std::max(config.external_force_N, 2.0 * friction_N) +
                             pushed_N + std::abs(force_N - before_N);
    return unknown_N / mechanics.mass_kg * period_s * period_s;
  }

  /// The same of friction that turns round and as much from outside, under no torque, in one period.
  [[nodiscard]] double Sudden_m() const noexcept {
    const double friction_N =
        std::max({friction.Fs_plus_N, friction.Fs_minus_N, friction.Fc_plus_N, friction.Fc_minus_N});
    return 2.0 * friction_N / mechanics.mass_kg * period_s * period_s;
  }

  /// Noise that one period adds, from the noise of one millisecond.
  [[nodiscard]] double PerPeriod(double per_millisecond) const noexcept {
    return per_millisecond * std::sqrt(period_s / 1e-3);
  }
};

}  // namespace contour
