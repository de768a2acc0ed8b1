#pragma once

#include "control/control_config.h"
#include "core/controller_name.h"

namespace contour {

/// Bandwidth of a controller's position loop as it was designed, Hz: of the slower direction.
[[nodiscard]] double LoopBandwidth_Hz(const ControllerConfig& config, ControllerName controller) noexcept;

/// Bandwidth of a rigid axis that is held as stiffly as by this controller, Hz; of the slower direction,
/// since at low speed a path has none. What an observer finds is answered at once, so there it is the
/// mean of both. `in_cascade`: the drives close the loop.
[[nodiscard]] double StiffnessBandwidth_Hz(const ControllerConfig& config, ControllerName controller,
                                           bool in_cascade) noexcept;

}  // namespace contour
