#pragma once

#include "tools/improve/working_space.h"

namespace contour::improve {

/// What is drawn where no program is given: a circle of 10 mm at 3 m/min in the plane of the improved axis
/// and another one, or what limits allow of it; on a machine of one axis a sine.
ProgramText UsualPath(const MachineConfig& machine, const WorkingSpace& space);

/// What no model is fitted on: smaller, slower and the other way round.
ProgramText UsualCheck(const MachineConfig& machine, const WorkingSpace& space);

}  // namespace contour::improve
