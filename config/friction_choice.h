#pragma once

#include "config/machine_config.h"

namespace contour {

/// Whether an axis's counts hide its friction (estimator/coarse_encoder.h): what a drive in csp reports is
/// noise then, and a filter that goes by every report takes that for friction. Learnt along the reference it
/// is averaged (docs/laboratory/family.md).
bool ReportsAreNoise(const AxisConfig& config, double period_s);

/// Whether kSrukf can be used at all: no axis has a linear scale, none a table that swings on its screw too
/// low for a filter with one rigid mass, none in csp an encoder one of whose counts is more than friction
/// moves it by in a cycle, and none in torque mode one that a step of the drive's torque moves by more than
/// half of its wind-up F / K.
bool FilterServes(const MachineConfig& machine);

/// What `full` knows friction by where a machine file does not say: kLinear where a drive is in torque mode;
/// elsewhere kSrukf if it serves. In torque mode an axis without a loop gets one when it is loaded; where
/// none is found at once kSrukf is used if it serves, or else the machine is refused
/// (design/loop_choice.h).
FrictionKind ChooseFriction(const MachineConfig& machine);

}  // namespace contour
