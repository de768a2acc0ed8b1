#pragma once

#include "config/machine_config.h"
#include "core/cycle_record.h"
#include "daemon/program/motion_plan.h"

namespace contour {

/// What the machine file allows a program to do, axis by axis.
PerAxis<PlanLimits> ProgramLimits(const MachineConfig& machine);

/// The same as it is now: an axis that does not know where it is may go as far as its guard lets it.
PerAxis<PlanLimits> LimitsNow(const PerAxis<PlanLimits>& limits, const CycleRecord& now);

}  // namespace contour
