#pragma once

#include <vector>

#include "analysis/diagnosis/adequacy/remaining_structure.h"

namespace contour::diagnosis {

/// Rows whose friction follows the motion, by the model.
std::vector<bool> Slides(const Problem& problem);

/// What a torque that no cause describes may depend on: position, speed, angle, temperature and the travel
/// since the last reversal, each with the direction, and time. Not the acceleration: there the drive's delay
/// and the couplings that every machine has show first.
std::vector<BinnedRows> StructureMaps(const Problem& problem, const std::vector<bool>& slides);

/// Friction over the speed: what the numbers of every model are for, and where what they cannot describe of
/// it shows first. Not a thing to call unknown.
BinnedRows FrictionCurve(const Problem& problem, const std::vector<bool>& slides);

}  // namespace contour::diagnosis
