#pragma once

#include <Eigen/Core>
#include <vector>

#include "analysis/identification/follow_gain.h"
#include "analysis/identification/linear_step.h"
#include "analysis/identification/measured.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// An axis, and how closely it follows what was measured.
struct Followed {
  TableAxis axis;
  FollowGain gain;
  int substeps = kSubSteps;  ///< of a period
};

/// Simulates each axis over the records, one after the other: led by the torque that was sent, corrected by
/// the position that was measured. Column i has measured minus predicted position of axis i, zero where there
/// is nothing to compare (no sample, or the first ones after a gap); run-ups have no rows in it. The screw
/// and viscous friction are stepped exactly (matrix exponential), the bristle between them (Strang
/// splitting); hold, delay and lag of the torque are exact. Axes run side by side (simd/), and a column does
/// not depend on its neighbours or on `threads`.
Eigen::MatrixXd PredictionErrors_m(const std::vector<Followed>& axes, const std::vector<Measured>& records,
                                   int threads);
/// Of one axis over one record.
std::vector<double> PredictionErrors_m(const TableAxis& axis, const Measured& data, const FollowGain& gain);

/// What the simulated axis did, at every grid point behind the correction.
struct Simulated {
  std::vector<double> table_m;     ///< the mass that rubs
  std::vector<double> friction_N;  ///< bristle and viscous friction of the whole axis
};
Simulated Simulate(const TableAxis& axis, const Measured& data, const FollowGain& gain);

/// Factor of the levels at a place, about 1.
double LevelFactor(const TableAxis& axis, double motor_m, double table_m, bool up);

}  // namespace contour::identify
