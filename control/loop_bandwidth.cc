#include "control/loop_bandwidth.h"

#include <algorithm>
#include <cmath>

#include "control/contour_controller.h"

namespace contour {
namespace {

// A controller without integral action or observer leaves friction to its stiffness alone.
constexpr double kUncompensated = 0.5;

}  // namespace

double LoopBandwidth_Hz(const ControllerConfig& config, ControllerName controller) noexcept {
  if (controller == ControllerName::kPid) return config.pid.bandwidth_Hz;
  const MpcConfig& mpc = MpcConfigFor(config, controller);
  return std::min(mpc.contour_bandwidth_Hz, mpc.lag_bandwidth_Hz);
}

double StiffnessBandwidth_Hz(const ControllerConfig& config, ControllerName controller,
                             bool in_cascade) noexcept {
  if (in_cascade || controller == ControllerName::kCsp || controller == ControllerName::kCnc)
    return config.monitor.drive_loop_Hz;
  if (controller == ControllerName::kMpc) return kUncompensated * LoopBandwidth_Hz(config, controller);
  if (controller == ControllerName::kMpcObserver)
    return std::sqrt(config.mpc_observer.contour_bandwidth_Hz * config.mpc_observer.lag_bandwidth_Hz);
  return LoopBandwidth_Hz(config, controller);
}

double StiffnessInUse_Hz(const ControllerConfig& config, ControllerName controller, bool in_cascade,
                         double least_regulator_Hz) noexcept {
  return std::isfinite(least_regulator_Hz) ? least_regulator_Hz
                                           : StiffnessBandwidth_Hz(config, controller, in_cascade);
}

}  // namespace contour
