#pragma once

namespace contour {

/// Exact motion of one rigid axis over one period, in position m, velocity m/s and commanded force per mass
/// m/s^2, with the drive's first-order lag and viscous friction:
///
///   position(k+1) = position(k) + position_from_velocity velocity(k)
///                   + position_from_command command(k) + position_from_previous command(k-1)
///                   + position_from_known known
///   velocity(k+1) = velocity_kept velocity(k) + velocity_from_command command(k)
///                   + velocity_from_previous command(k-1) + velocity_from_known known
///
/// `known` is any other acceleration, constant over the period. The lag leaves the force of command(k-1)
/// acting in the first part of the period; that it has reached command(k-1) by then is the one approximation,
/// of size exp(-period/lag).
struct AxisDynamics {
  double position_from_velocity = 0.0;
  double position_from_command = 0.0;
  double position_from_previous = 0.0;
  double position_from_known = 0.0;
  double velocity_kept = 1.0;
  double velocity_from_command = 0.0;
  double velocity_from_previous = 0.0;
  double velocity_from_known = 0.0;
};

/// `viscous_1_s` is viscous friction over mass. Throws std::invalid_argument when a value is negative or the
/// period is not positive.
AxisDynamics DiscretizeAxis(double period_s, double lag_s, double viscous_1_s);

}  // namespace contour
