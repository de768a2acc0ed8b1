#pragma once

#include "config/machine_config.h"
#include "core/controller_name.h"
#include "daemon/rt/cycle_config.h"

namespace contour {

/// What the cycle needs of a machine file, with the drives in the mode that the controller wants (csp: cyclic
/// synchronous position).
CycleConfig MakeCycleConfig(const MachineConfig& machine, ControllerName controller);

}  // namespace contour
