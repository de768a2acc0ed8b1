#pragma once

#include "core/two_inertia_loop.h"

// An experiment's spring on an axis that has a loop: the loop itself, weaker. Through its observer and its
// torque filter nothing acts that it was not designed and judged with; a stiffness and a damping of their own
// would excite the screw's mode wherever the observer's model of it is off.
namespace contour {

/// Of the regulator's gains: of positions, and of velocities and of forces under way. With s of the latter
/// and s^2 of the former the axis keeps its damping ratio.
struct SpringShares {
  double position = 1.0;
  double velocity = 1.0;
};

/// Force per metre with which the loop holds an axis at rest, but for what it finds of a disturbance.
[[nodiscard]] double HoldingStiffness_N_m(const TwoInertiaLoop& loop) noexcept;

/// The stiffest spring: what the loop finds of a disturbance, which a spring leaves alone, is part of what
/// the loop was judged with; with half of its stiffness there is margin without.
[[nodiscard]] double StiffestSpring_N_m(const TwoInertiaLoop& loop) noexcept;

/// Of a spring of this stiffness; of the stiffest, where more is asked for.
[[nodiscard]] SpringShares SharesOfSpring(const TwoInertiaLoop& loop, double spring_N_m) noexcept;

/// That spring as a loop.
[[nodiscard]] TwoInertiaLoop SpringLoop(const TwoInertiaLoop& loop, double spring_N_m) noexcept;

}  // namespace contour
