#pragma once

#include <vector>

#include "config/machine_checks.h"
#include "config/machine_config.h"

namespace contour {

/// Names that would not get through the columns of CSV, the keys of a file, file names and messages as they
/// are: of the machine, its axes and its buses.
std::vector<ConfigProblem> CheckNames(const MachineConfig& machine);

}  // namespace contour
