#pragma once

#include <string>

#include "config/machine_config.h"

namespace contour {

/// What became of a machine under its controller, and of which; empty: it did not happen.
struct ControllerTrial {
  std::string lost;      ///< stopped
  std::string softened;  ///< the supervision of its loops softened them, and it went on
};

/// Whether the machine's controller holds it, in virtual time: enabled, at rest, then a slow stroke of each
/// axis, on the machine that its models state and with inertias and stiffness off by what is not known of
/// them. For controllers that come without a loop whose margins could be told. Tells of the first of these
/// machines each; ends with one that is lost. Some tenths of a second.
ControllerTrial TryController(const MachineConfig& machine);

}  // namespace contour
