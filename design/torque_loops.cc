#include "design/torque_loops.h"

#include <utility>

#include "config/loop_axis.h"
#include "config/machine_checks.h"
#include "design/start_loop.h"

namespace contour {
namespace {

/// What the axis has not in torque mode with this loop that a machine must have; empty: nothing.
std::string WhatItLacks(const MachineConfig& machine, const std::string& name, const LoopTuning& loop) {
  MachineConfig there = InTorqueMode(machine, {{name, loop}});
  // All axes change their modes together, and the others are asked for themselves.
  for (auto& [other, axis] : there.axes) axis.drive.mode = DriveMode::kCst;
  for (const ConfigProblem& p : Check(there))
    if (p.key.starts_with("axes." + name + ".")) return p.key + " does not do there: " + p.message;
  return {};
}

}  // namespace

TorqueLoops FindTorqueLoops(const MachineConfig& machine, int threads,
                            std::map<std::string, LoopTuning> known) {
  TorqueLoops found{std::move(known), {}, {}};
  if (machine.machine.controller != ControllerName::kFull) {
    found.why_not = "the controller " + std::string(Name(machine.machine.controller)) + " has no loop for it";
    return found;
  }
  // Its loop with the scale would be used, which nobody has judged for what the model leaves open.
  for (const auto& [name, axis] : machine.axes)
    if (axis.scale_loop) {
      found.why_not = "axis " + name + " has a loop that takes its scale";
      return found;
    }
  const double period_s = 1e-6 * machine.machine.cycle_us;
  for (const auto& [name, axis] : machine.axes) {
    if (!found.loops.contains(name)) {
      const StartLoop start = FindStartLoop(LoopAxisOf(axis), period_s, threads, DoubtOf(axis.model));
      if (!start.wrong.empty()) {
        found.lacking.push_back(name);
        if (found.why_not.empty())
          found.why_not =
              "no loop of axis " + name + " is stable for all that its model leaves open: " + start.wrong;
        continue;
      }
      found.loops[name] = start.found.tuning;
    }
    // A record in csp, and a better model by it, would not help.
    if (const std::string lacks = WhatItLacks(machine, name, found.loops.at(name)); !lacks.empty())
      return {{}, {}, lacks};
  }
  return found;
}

MachineConfig InCsp(MachineConfig machine) {
  machine.control.friction = FrictionKind::kLinear;
  for (auto& [name, axis] : machine.axes) axis.drive.mode = DriveMode::kCsp;
  return machine;
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
