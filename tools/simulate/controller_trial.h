#pragma once

#include <string>

#include "config/machine_config.h"

namespace contour {

/// Whether the machine's controller holds it, in virtual time: enabled, at rest, then a slow stroke of each
/// axis, on the machine that its models state and with inertias and stiffness off by what is not known of
/// them. For controllers that come without a loop whose margins could be told. Gives what became of it, on
/// the first of these machines that is lost; empty: none is. Some tenths of a second.
std::string HowControllerIsLost(const MachineConfig& machine);

}  // namespace contour
