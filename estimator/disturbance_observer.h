#pragma once

#include <cstdint>

#include "core/axis.h"
#include "estimator/axis_estimator_input.h"
#include "estimator/drive_lag.h"
#include "estimator/filter_setup.h"
#include "estimator/sqrt_ekf.h"

namespace contour {

/// Kalman filter [position, velocity, disturbance] of the rigid axis: m v' = u - sigma2 v - d, d a random
/// walk. What friction is beyond viscous shows up in d. The noise of d follows from the bandwidth: with d
/// driving a chain of three integrators the optimal observer has Butterworth poles at w = 2 pi f when d's
/// noise over one period is m w^3 r Ts, r the measurement's standard deviation.
class DisturbanceObserver {
 public:
  explicit DisturbanceObserver(const FilterSetup& setup) noexcept;

  void Reset(double position_m) noexcept;
  AxisEstimate Update(const AxisEstimatorInput& in) noexcept;

  /// Disturbance and viscous friction in the middle of the interval in which the next torque acts.
  [[nodiscard]] double FrictionAhead_N() const noexcept { return friction_ahead_N_; }

 private:
  using X = StateVector<3>;
  void Propagate(X& x, double force_N) const noexcept;

  FilterSetup setup_;
  DriveLag<1> lag_;
  SqrtEkf<3> core_;
  X noise_{};
  double velocity_decay_ = 1.0;
  double velocity_gain_ = 0.0;
  double friction_ahead_N_ = 0.0;
  SuddenGate gate_;
  std::uint32_t gated_in_a_row_ = 0;
};

}  // namespace contour
