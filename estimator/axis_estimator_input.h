#pragma once

#include <array>
#include <limits>

namespace contour {

/// What the estimator of one axis takes in per cycle. "Table units": forces are torque / R.
struct AxisEstimatorInput {
  double position_m = 0.0;  ///< R theta of the newest feedback, latched at t(k-1)
  bool fresh = false;       ///< false: no new feedback; the filter only predicts
  double scale_m = 0.0;     ///< reading of the linear scale at the same instant, from a zero of its own
  bool scale_fresh = false;
  /// Torque commands over R as really sent (limited, rounded to the drive's steps), newest first:
  /// u(k-1), which acts over [t(k-1), t(k)), then u(k-2), u(k-3).
  std::array<double, 3> force_N{};
  double commanded_velocity_m_s = 0.0;  ///< reference at t(k-1)
  double commanded_acceleration_m_s2 = 0.0;
  double temperature_degC = std::numeric_limits<double>::quiet_NaN();  ///< of the screw; NaN: unknown
  bool at_rest = true;   ///< commanded velocity is zero: friction parameters keep their values
  bool alone = true;     ///< no other axis is commanded to move
  bool enabled = false;  ///< the drive turns torque into motion; otherwise only the position is followed
};

}  // namespace contour
