#pragma once

#include <cstddef>
#include <vector>

#include "analysis/identification/kinematics.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// Stiffness of the bristle from what happens right after reversals. A reversal out of full sliding begins
/// with the slope sigma0 (1 + |F| / g), twice sigma0 when symmetric; out of smaller loops with less. The
/// screw's own wind-up is taken off the motor's travel.
struct PreslidingFit {
  bool found = false;
  double sigma0_N_m = 0.0;  ///< median over the reversals
  double spread_N_m = 0.0;  ///< half the distance of the quartiles
  std::size_t reversals = 0;
};
PreslidingFit FitPresliding(const std::vector<Instant>& instants, const TableAxis& axis);

/// Break-away and Coulomb levels of single motions, as one reads them off: the largest friction within a few
/// bristle lengths after a reversal, and the mean beyond.
struct BreakAway {
  double force_N = 0.0;  ///< signed as the motion
  double velocity_m_s = 0.0;
};
std::vector<BreakAway> BreakAways(const std::vector<Instant>& instants, const TableAxis& axis);

/// Friction over the table's travel, for pictures: motions that reverse within `largest_m`.
struct LoopPoint {
  double time_s = 0.0, travel_m = 0.0, friction_N = 0.0;
};
std::vector<LoopPoint> PreslidingLoops(const std::vector<Instant>& instants, const TableAxis& axis,
                                       double largest_m);

}  // namespace contour::identify
