#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/machine_config.h"
#include "core/loop_tuning.h"

namespace contour {

/// With what a machine whose drives close their own loops can be commissioned in torque mode. There every
/// force that acts is one that was sent; of what a drive's loop does between two reports nobody knows.
struct TorqueLoops {
  std::map<std::string, LoopTuning> loops;  ///< of the axes that have one
  std::vector<std::string> lacking;         ///< axes that are not known well enough for one
  std::string why_not;                      ///< in plain words; empty: all have one
  [[nodiscard]] bool complete() const { return why_not.empty() && !loops.empty(); }
};

/// Loops that are stable for all that the models leave open (FindStartLoop). All axes are enabled together,
/// so all of them must have one, and a machine file that holds for it: where the limits of an axis do not do
/// in torque mode, that is said and no further axis is searched. Axes of which one is known already are not
/// searched again. Some ten seconds of processor time for each of the others.
TorqueLoops FindTorqueLoops(const MachineConfig& machine, int threads,
                            std::map<std::string, LoopTuning> known = {});

/// The machine with all axes in csp, held by the loops of their drives; friction as with loops from here.
MachineConfig InCsp(MachineConfig machine);

/// The machine in torque mode with these loops; as it is without any.
MachineConfig InTorqueMode(MachineConfig machine, const std::map<std::string, LoopTuning>& loops);

}  // namespace contour
