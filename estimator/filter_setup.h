#pragma once

#include <cmath>

#include "core/mechanics.h"
#include "estimator/estimator_config.h"
#include "estimator/friction_config.h"

namespace contour {

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

  /// Noise that one period adds, from the noise of one millisecond.
  [[nodiscard]] double PerPeriod(double per_millisecond) const noexcept {
    return per_millisecond * std::sqrt(period_s / 1e-3);
  }
};

}  // namespace contour
