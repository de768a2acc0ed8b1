#pragma once

#include <string>

#include "config/machine_config.h"

namespace contour {

/// For `contour check`: how much of a program's tolerance is left for the machine to follow its path. Loops
/// that are missing have been put in.
std::string PathSection(const MachineConfig& machine);

}  // namespace contour
