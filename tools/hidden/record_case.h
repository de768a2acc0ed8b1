#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "tools/hidden/hidden_case.h"

namespace contour::hidden {

/// The machine runs its program under the daemon's own cycle, on a loopback bus in virtual time, and writes
/// its log. What comes back was read from that log and from a model file, like a user's. `effects`: hidden
/// in the machine; none: a clean one. Files go to `directory`, which must exist. Throws std::runtime_error
/// when the machine faults.
Recorded Record(const Setting& setting, const std::vector<Hidden>& effects,
                const std::filesystem::path& directory);

/// The same without a log file: for measuring the strength of an effect.
diagnosis::AxisLog Simulate(const Setting& setting, const std::vector<Hidden>& effects,
                            const std::filesystem::path& directory);

}  // namespace contour::hidden
