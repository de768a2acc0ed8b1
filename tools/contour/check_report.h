#pragma once

#include <string>

#include "config/machine_config.h"

namespace contour {

/// What `contour check` prints of a machine that can work: axes, limits, reserve, stopping bounds, bus,
/// timing.
std::string CheckReport(const MachineConfig& config);

}  // namespace contour
