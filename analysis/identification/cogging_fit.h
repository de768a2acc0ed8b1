#pragma once

#include <array>
#include <vector>

#include "analysis/identification/kinematics.h"
#include "analysis/identification/sliding_fit.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// Torques of the motor that go with its angle, from the force that slow sliding takes: of each whole order
/// per turn whether it explains far more than its neighbours, the same in both directions. Friction that goes
/// with the angle turns its sign with the direction and is no cogging. `instants` are as measured, without
/// cogging taken off them. `window_s` is what they average over.
std::array<MotorWave, kMostWaves> FindCogging(const std::vector<Instant>& instants, const TableAxis& axis,
                                              const SlidingFit& sliding, double window_s);

}  // namespace contour::identify
