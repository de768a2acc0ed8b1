#pragma once

#include "config/machine_config.h"

namespace contour {

/// What `full` knows friction by where a machine file does not say: kLinear where the lowest mode of motor
/// against table is too low for a filter with one rigid mass in the mode of the drives, kSrukf elsewhere,
/// and in torque mode where an axis has no loop.
FrictionKind ChooseFriction(const MachineConfig& machine);

}  // namespace contour
