#pragma once

#include <algorithm>
#include <cmath>

#include "core/mechanics.h"
#include "estimator/coarse_encoder.h"
#include "estimator/estimator_config.h"
#include "estimator/friction_config.h"

namespace contour {

/// Friction that turns round is twice itself; an outside force may be as large.
inline constexpr double kSuddenFrictions = 4.0;

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
  double encoder_step_m = 0.0;   ///< a count; 0: not stated

  /// A drive closes the loop by counts behind which friction does not show in time.
  [[nodiscard]] bool Shaken() const noexcept {
    return reported_torque && CountsHideFriction(encoder_step_m, friction, mechanics.mass_kg, period_s);
  }

  /// So far a change of force takes an axis in one period, a T^2 / 2: friction that turns round, and as much
  /// from outside. A single reading that is further off is no motion.
  [[nodiscard]] double Sudden_m() const noexcept {
    const double friction_N =
        std::max({friction.Fs_plus_N, friction.Fs_minus_N, friction.Fc_plus_N, friction.Fc_minus_N});
    return 0.5 * kSuddenFrictions * friction_N / mechanics.mass_kg * period_s * period_s;
  }

  /// Mean of both directions: what the noises of friction are stated by.
  [[nodiscard]] double Coulomb_N() const noexcept { return 0.5 * (friction.Fc_plus_N + friction.Fc_minus_N); }

  /// Noise that one period adds, from the noise of one millisecond.
  [[nodiscard]] double PerPeriod(double per_millisecond) const noexcept {
    return per_millisecond * std::sqrt(period_s / 1e-3);
  }
};

}  // namespace contour
