#pragma once

#include "tools/improve/working_space.h"

namespace contour::improve {

/// Where none are given: those of commissioning, with a way of three turns of the motor at least, as far as
/// the stroke has them. On a shorter one what repeats with the motor's turn passes for a shape over the
/// stroke.
CommissionLimits UsualLimits(const AxisConfig& axis);

/// What is drawn where no program is given: a circle of 10 mm (of one lead, where that is more) at 3 m/min in
/// the plane of the improved axis and another one, or what limits allow of it; on a machine of one axis a
/// sine.
ProgramText UsualPath(const MachineConfig& machine, const WorkingSpace& space);

/// What no model is fitted on: smaller, slower and the other way round.
ProgramText UsualCheck(const MachineConfig& machine, const WorkingSpace& space);

}  // namespace contour::improve
