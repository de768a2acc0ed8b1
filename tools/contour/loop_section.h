#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// What `contour check` says of the two-inertia loops of a machine.
struct LoopSection {
  std::string text;
  std::vector<std::string> refused;  ///< why an axis may not be moved with its loop, one message each
  std::vector<std::string> chosen;   ///< the loops of axes that state none, as assignments
};

/// Loops act where `full` gives torques and has friction linear (control.friction); in csp the drive closes
/// them. Margins of a loop that is not in use are printed, and refuse nothing. Of axes without `loop:` it
/// says what would find one.
LoopSection JudgeLoops(const MachineConfig& machine);

}  // namespace contour
