#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "tools/validation/hidden/hidden_case.h"

namespace contour::hidden {

/// The machine runs its program under the daemon's own cycle, on a loopback bus in virtual time. `effects`:
/// hidden in the machine; none: a clean one. Leaves log.lcm, model.yaml and machine.yaml in `directory`,
/// which must exist. Throws std::runtime_error when the machine faults.
LogSpan Record(const Setting& setting, const std::vector<Hidden>& effects,
               const std::filesystem::path& directory);

/// Puts the log of such a directory into log.csv instead, which takes a tenth of the room.
void Compact(const std::filesystem::path& directory);

/// Log and model of such a directory, read like a user's.
Recorded ReadRecorded(const std::filesystem::path& directory);

/// The same run without a log file: for measuring the strength of an effect.
diagnosis::AxisLog Simulate(const Setting& setting, const std::vector<Hidden>& effects,
                            const std::filesystem::path& directory);

}  // namespace contour::hidden
