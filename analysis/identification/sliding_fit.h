#pragma once

#include <string>
#include <vector>

#include "analysis/identification/kinematics.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// Friction over speed from everything that slides: one regression of the force on acceleration, speed, the
/// levels of each direction and their Stribeck share, for each of a series of Stribeck velocities.
struct SlidingFit {
  bool found = false;
  std::string why_not;  ///< what the record lacks
  double mass_kg = 0.0;
  double Fc_plus_N = 0.0, Fc_minus_N = 0.0;
  double Fs_plus_N = 0.0, Fs_minus_N = 0.0;
  double offset_N = 0.0;  ///< constant force; only where friction alone would not oppose motion
  double vs_m_s = 0.0;
  double sigma2_Ns_m = 0.0;
  double residual_rms_N = 0.0;
};
/// Sliding for certain: fast enough, and far enough from the last reversal.
bool Slides(const Instant& instant);
SlidingFit FitSliding(const std::vector<Instant>& instants, double stribeck_exponent, double radius_m_rad);

/// One speed of the Stribeck curve: mean friction of the runs at (nearly) constant speed, as it is at the
/// average place (short strokes see but one place of a turn).
struct StribeckPoint {
  double velocity_m_s = 0.0;
  double friction_N = 0.0;
  double spread_N = 0.0;  ///< standard deviation over the travel: ripple and place
  double travel_m = 0.0;
};
std::vector<StribeckPoint> StribeckPoints(const std::vector<Instant>& instants, const TableAxis& axis);

}  // namespace contour::identify
