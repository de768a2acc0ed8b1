#pragma once

#include "config/machine_config.h"
#include "daemon/program/motion_plan.h"

namespace contour {

/// What the machine file allows a program to do, axis by axis.
PerAxis<PlanLimits> ProgramLimits(const MachineConfig& machine);

}  // namespace contour
