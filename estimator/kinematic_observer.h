#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/axis.h"
#include "estimator/axis_estimator_input.h"
#include "estimator/drive_lag.h"
#include "estimator/exponential.h"
#include "estimator/filter_setup.h"

namespace contour {

/// Position, velocity and acceleration from the encoder: a third-order observer with three equal poles
/// (fading-memory g-h-k filter). Knows nothing of friction; the change of the motor's force from one period
/// to the next enters the acceleration, without which the observer's lag would destabilise a stiff loop.
class KinematicObserver {
 public:
  KinematicObserver() noexcept = default;
  explicit KinematicObserver(const FilterSetup& setup) noexcept
      : period_s_(setup.period_s),
        inverse_mass_1_kg_(1.0 / setup.mechanics.mass_kg),
        lag_(setup.period_s, setup.lag_s) {
    const double pole = Exp(-2.0 * std::numbers::pi * setup.config.observer_bandwidth_Hz * period_s_);
    const double rest = 1.0 - pole;
    position_gain_ = 1.0 - pole * pole * pole;
    velocity_gain_ = 1.5 * rest * rest * (1.0 + pole) / period_s_;
    acceleration_gain_ = rest * rest * rest / (period_s_ * period_s_);
  }

  void Reset(double position_m) noexcept {
    position_m_ = position_m;
    velocity_m_s_ = acceleration_m_s2_ = mean_force_N_ = 0.0;
    gated_in_a_row_ = 0;
    lag_.Reset();
  }

  AxisEstimate Update(const AxisEstimatorInput& in) noexcept;

 private:
  double period_s_ = 1e-3;
  double inverse_mass_1_kg_ = 0.0;
  DriveLag<1> lag_;
  double mean_force_N_ = 0.0;
  std::uint32_t gated_in_a_row_ = 0;
  double position_gain_ = 0.0;
  double velocity_gain_ = 0.0;
  double acceleration_gain_ = 0.0;
  double position_m_ = 0.0;
  double velocity_m_s_ = 0.0;
  double acceleration_m_s2_ = 0.0;
};

}  // namespace contour
