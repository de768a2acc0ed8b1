#pragma once

#include <map>
#include <string>

#include "config/machine_config.h"
#include "core/loop_tuning.h"

namespace contour {

/// With what a machine whose drives close their own loops can be commissioned in torque mode. There every
/// force that acts is one that was sent; of what a drive's loop does between two reports nobody knows.
struct TorqueLoops {
  std::map<std::string, LoopTuning> loops;  ///< of all axes; empty: it cannot
  std::string why_not;                      ///< in plain words, where it cannot
};

/// Loops that are stable for all that the models leave open (FindStartLoop). All axes are enabled together,
/// so all of them must have one. Some ten seconds of processor time for each axis.
TorqueLoops FindTorqueLoops(const MachineConfig& machine, int threads);

/// The machine in torque mode with these loops; as it is without any.
MachineConfig InTorqueMode(MachineConfig machine, const std::map<std::string, LoopTuning>& loops);

}  // namespace contour
