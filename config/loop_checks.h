#pragma once

#include <vector>

#include "config/machine_checks.h"
#include "config/machine_config.h"

namespace contour {

/// Whether every axis has the two-inertia loop that `control.friction: linear` asks for in torque mode.
std::vector<ConfigProblem> CheckLoops(const MachineConfig& config);

}  // namespace contour
