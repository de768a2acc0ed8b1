#pragma once

#include <array>

#include "control/axis_dynamics.h"

namespace contour {

/// Lower Cholesky factor of a 2 x 2 matrix over (position, velocity).
struct TerminalFactor {
  double pp = 0.0, vp = 0.0, vv = 0.0;  ///< [pp 0; vp vv]
};

/// Cost-to-go of the unconstrained infinite horizon from one axis's drift state (control/qp_problem.h), for
/// cost 1/2 weight error^2 + 1/2 effort u^2 per interval: the stabilising solution of the Riccati equation,
/// found by iterating it. Throws std::invalid_argument when weight or effort is not positive or it does not
/// converge.
TerminalFactor LqrTerminal(const AxisDynamics& dynamics, double weight, double effort);

}  // namespace contour
