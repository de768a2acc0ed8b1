#pragma once

#include <string>
#include <vector>

#include "config/machine_checks.h"

namespace contour {

/// Reactions to emergency messages may be made stronger than the table has them, never weaker. `key` is that
/// of the drive.
std::vector<ConfigProblem> CheckEmergencyReactions(const DriveConfig& drive, const std::string& key);

}  // namespace contour
