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

/// The same where axes may have loops of their own: as stiff as the softest of them, `least_regulator_Hz`,
/// which is infinite where none is in use. The cycle tells its monitors of it, and `contour check` goes by
/// it.
[[nodiscard]] double StiffnessInUse_Hz(const ControllerConfig& config, ControllerName controller,
                                       bool in_cascade, double least_regulator_Hz) noexcept;

}  // namespace contour
