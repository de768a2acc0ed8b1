#pragma once

#include <vector>

#include "config/machine_config.h"
#include "tools/plant_emulator/emulated_machine.h"

namespace contour {

/// Where the axes of a machine file sit on its buses, in the order of their numbers, and what their drives
/// are unless `emulator:` says otherwise. The drives' identity is the emulator's own, so that a wrong one in
/// the file is noticed.
std::vector<EmulatedAxisPlacement> EmulatedPlacements(const MachineConfig& machine);

}  // namespace contour
