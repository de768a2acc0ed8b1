#include "config/loop_checks.h"

#include <stdexcept>
#include <string>
#include <tuple>

#include "config/extended_model.h"
#include "core/two_inertia_axis.h"
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
    if (!axis.loop) {
      problems.push_back({key,
                          "found nothing, but control.friction is linear and drive.mode cst: expected the "
                          "tuning that `contour tune --from-model` writes"});
      continue;
    }
    const ExtendedModel model = Extended(axis.model);
    const Mechanics mechanics = ToSi(model.mechanics);
    const double sigma2 = ToSi(model.friction, mechanics.radius_m_rad).sigma2_Ns_m;
    try {
      std::ignore =
          DesignLoop(ToTwoInertiaAxis(mechanics, sigma2, 1e-3 * axis.drive.lag_ms, axis.drive.delay_cycles),
                     *axis.loop, 1e-6 * c.machine.cycle_us, false);
    } catch (const std::invalid_argument& e) {
      problems.push_back({key, std::string("found a tuning that gives no loop: ") + e.what()});
    }
  }
  return problems;
}

}  // namespace contour
