#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// What a machine file may state but should not, for its drives' mode: a sentence each. Nothing is refused
/// for it.
std::vector<std::string> ModeAdvice(const MachineConfig& machine);

}  // namespace contour
