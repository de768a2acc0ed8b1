#include "config/loop_checks.h"

#include <stdexcept>
#include <string>
#include <tuple>

#include "config/loop_axis.h"
#include "core/two_inertia_loop.h"
#include "drivers/cia402/mode_for.h"

namespace contour {

std::vector<ConfigProblem> CheckLoops(const MachineConfig& c) {
  std::vector<ConfigProblem> problems;
  if (c.machine.controller != ControllerName::kFull || c.control.friction != FrictionKind::kLinear)
    return problems;
  for (const auto& [name, axis] : c.axes) {
    if (ModeFor(c.machine.controller, axis.drive) == DriveMode::kCsp) continue;
    const std::string key = "axes." + name + ".loop";
    if (!axis.loop) continue;  // design/loop_choice.h finds one, or says why there is none
    try {
      std::ignore = DesignLoop(TwoInertiaAxisOf(axis), *axis.loop, 1e-6 * c.machine.cycle_us, false);
    } catch (const std::invalid_argument& e) {
      problems.push_back({key, std::string("found a tuning that gives no loop: ") + e.what()});
    }
  }
  return problems;
}

}  // namespace contour
