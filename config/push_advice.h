#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// Of each axis whose stated weight or spring leaves too little of what the file allows: a line each. Nothing
/// is refused for it; where the axis could not be held, or not be stopped within its limits, Check() does.
std::vector<std::string> PushAdvice(const MachineConfig& machine);

}  // namespace contour
