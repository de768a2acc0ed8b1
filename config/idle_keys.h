#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"
#include "config/yaml_tree.h"

namespace contour {

/// Keys that a machine file states and that nothing goes by, for the controller, the drives' mode and the
/// friction law that the machine has: a sentence each, which begins with the place. Nothing is refused for
/// it, since the same file may serve other controllers and modes.
std::vector<std::string> IdleKeys(const YamlValue& tree, const MachineConfig& machine);

}  // namespace contour
