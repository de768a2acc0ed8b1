#include "design/torque_loops.h"

#include <utility>

#include "config/loop_axis.h"
#include "design/start_loop.h"

namespace contour {

TorqueLoops FindTorqueLoops(const MachineConfig& machine, int threads) {
  if (machine.machine.controller != ControllerName::kFull)
    return {{}, "the controller " + std::string(Name(machine.machine.controller)) + " has no loop for it"};
  TorqueLoops found;
  const double period_s = 1e-6 * machine.machine.cycle_us;
  for (const auto& [name, axis] : machine.axes) {
    // Its loop with the scale would be used, which nobody has judged for what the model leaves open.
    if (axis.scale_loop) return {{}, "axis " + name + " has a loop that takes its scale"};
    const StartLoop start = FindStartLoop(LoopAxisOf(axis), period_s, threads, DoubtOf(axis.model));
    if (!start.wrong.empty())
      return {{},
              "no loop of axis " + name + " is stable for all that its model leaves open: " + start.wrong};
    found.loops[name] = start.found.tuning;
  }
  return found;
}

MachineConfig InTorqueMode(MachineConfig machine, const std::map<std::string, LoopTuning>& loops) {
  if (!loops.empty()) machine.control.friction = FrictionKind::kLinear;
  for (const auto& [name, loop] : loops) {
    AxisConfig& axis = machine.axes.at(name);
    axis.drive.mode = DriveMode::kCst;
    axis.loop = loop;
  }
  return machine;
}

}  // namespace contour
