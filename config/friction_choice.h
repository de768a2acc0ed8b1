#pragma once

#include "config/machine_config.h"

namespace contour {

/// What `full` knows friction by where a machine file does not say: kLinear where the table of some axis, on
/// its screw, swings too low for a filter with one rigid mass, or has a linear scale, or, in torque mode, is
/// moved by one step of the drive's torque by more than half of its wind-up F / K; kSrukf elsewhere. In
/// torque mode an axis without a loop gets one when it is loaded, or is refused (design/loop_choice.h).
FrictionKind ChooseFriction(const MachineConfig& machine);

}  // namespace contour
