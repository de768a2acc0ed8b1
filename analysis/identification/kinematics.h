#pragma once

#include <cstddef>
#include <vector>

#include "analysis/identification/simulation.h"

namespace contour::identify {

/// Velocity, acceleration and force about one instant, all through the same short average, so that force =
/// m a + friction holds for the averages.
struct Instant {
  std::size_t row = 0;
  double time_s = 0.0;
  double position_m = 0.0;  ///< motor, R theta
  double velocity_m_s = 0.0;
  double acceleration_m_s2 = 0.0;
  double force_N = 0.0;  ///< at the motor, behind delay and lag
  /// Travel since the velocity last changed its sign (or since the record began).
  double since_reversal_m = 0.0;
};

/// Instants where all samples of the average are there, every `stride` rows. The second difference is the
/// mean of the acceleration under a triangle of two periods, so force goes through the same triangle.
/// `direct_N`, one per row or none, acts on the motor besides, at the row itself.
std::vector<Instant> Kinematics(const Measured& data, double delay_s, double lag_s, int half_width,
                                std::size_t stride, const std::vector<double>& direct_N = {});

}  // namespace contour::identify
