#pragma once

#include <string>
#include <vector>

namespace contour {

// Torque mode for a while, whatever the machine file says: commissioning asks for it where drives close their
// own loops, since a force that is sent is known better than one that a drive reports.

/// Assignments that put every axis into torque mode with these loops, AXIS=YAML; none for none. Throws
/// ConfigError at what is not an axis and its loop.
std::vector<std::string> TorqueModeOverrides(const std::vector<std::string>& loops);

/// Assignments less those of TorqueModeOverrides() for these axes.
std::vector<std::string> WithoutTorqueMode(const std::vector<std::string>& axes,
                                           std::vector<std::string> overrides);

}  // namespace contour
