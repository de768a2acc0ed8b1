#pragma once

#include <vector>

#include "analysis/identification/measured.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// What a model leaves unexplained, rms, as a force at the mass that rubs that would last; where a quick
/// force shakes the axis, less by as much as that adds to friction.
struct UnexplainedForce {
  /// Not foreseen, and the same whatever the axis does: noise of torque and encoder.
  double noise_N = 0.0;
  /// What goes with the motion: foreseen from other stretches of it, or there in some motions only.
  double structure_N = 0.0;
  double friction_N = 0.0;  ///< level that they are to be compared with
};

/// Tells noise from structure in the prediction errors, by three signs. A force that goes with the motor's
/// angle and direction, the place, the speed or the travel since the last reversal, and that the axis has
/// not, is fitted through what the simulation makes of a force to half of the blocks of time, and judged on
/// the other half, in turn: noise, however large, is not foreseen so. White noise of torque and encoder gives
/// errors of a known spectrum, whose quick half says how much there is of it. And it is there in every
/// motion: what the errors have beyond what noise makes of them, as large as the quieter blocks allow and as
/// uneven as the model says, comes of some motions, as where a bristle is wrong.
UnexplainedForce FindUnexplainedForce(const TableAxis& axis, const std::vector<Measured>& records,
                                      int threads);

}  // namespace contour::identify
