#pragma once

#include "daemon/options.h"

namespace contour {

/// Runs the daemon until it is asked to end. Returns the exit status; throws ConfigError, EnvironmentError or
/// BusUnavailable before anything has been sent to a drive.
int RunDaemon(const DaemonOptions& options);

}  // namespace contour
