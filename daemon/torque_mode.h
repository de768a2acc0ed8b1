#pragma once

#include <string>
#include <vector>

#include "daemon/new_start.h"

namespace contour {

// Torque mode for a while, whatever the machine file says: commissioning asks for it where drives close their
// own loops, since a force that is sent is known better than one that a drive reports.

/// Assignments that put every axis into torque mode; none without loops. Throws ConfigError at what is not an
/// axis and its keys.
std::vector<std::string> TorqueModeOverrides(const TorqueMode& mode);

/// Assignments less mode and loops of TorqueModeOverrides() for these axes.
std::vector<std::string> WithoutTorqueMode(const std::vector<std::string>& axes,
                                           std::vector<std::string> overrides);

}  // namespace contour
