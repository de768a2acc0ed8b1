#pragma once

#include <string>
#include <vector>

#include "config/machine_checks.h"
#include "config/machine_config.h"

// Limits and deadlines that are so wide that they bound nothing. Each is compared with other numbers of the
// same file: the stroke, the stopping bounds, the drive's own periods.
namespace contour {

/// Of one axis: how far it may leave its path, and how long drive and I/O may be silent.
std::vector<ConfigProblem> ImplausibleLimits(const MachineConfig& machine, const std::string& axis);

/// Telemetry that routers would pass on, unless the file says that it shall.
std::vector<ConfigProblem> ImplausibleTelemetry(const TelemetryConfig& telemetry);

}  // namespace contour
