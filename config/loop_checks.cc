#include "config/loop_checks.h"

#include <stdexcept>
#include <string>
#include <tuple>

#include "config/loop_axis.h"
#include "core/two_inertia_loop.h"
#include "drivers/cia402/mode_for.h"

namespace contour {

namespace {

/// What is wrong with a tuning, or nothing.
void CheckTuning(const MachineConfig& c, const AxisConfig& axis, const std::string& key,
                 const LoopTuning& tuning, bool scale, std::vector<ConfigProblem>& problems) {
  try {
    std::ignore = DesignLoop(TwoInertiaAxisOf(axis), tuning, 1e-6 * c.machine.cycle_us, scale);
  } catch (const std::invalid_argument& e) {
    problems.push_back({key, std::string("found a tuning that gives no loop: ") + e.what()});
  }
}

}  // namespace

std::vector<ConfigProblem> CheckLoops(const MachineConfig& c) {
  std::vector<ConfigProblem> problems;
  for (const auto& [name, axis] : c.axes)
    if (axis.scale_loop && !axis.drive.linear_scale)
      problems.push_back({"axes." + name + ".scale_loop",
                          "found a tuning with a linear scale in the loop, but the drive has none; expected "
                          "drive.linear_scale, or no scale_loop"});
  if (!KnowsTwoInertias(c.machine.controller, c.control.friction)) return problems;
  for (const auto& [name, axis] : c.axes) {
    if (ModeFor(c.machine.controller, axis.drive) == DriveMode::kCsp) continue;
    const std::string key = "axes." + name + ".";
    if (!axis.loop) continue;  // design/loop_choice.h finds one, or says why there is none
    CheckTuning(c, axis, key + "loop", *axis.loop, false, problems);
    if (axis.scale_loop && axis.drive.linear_scale)
      CheckTuning(c, axis, key + "scale_loop", *axis.scale_loop, true, problems);
  }
  return problems;
}

}  // namespace contour
