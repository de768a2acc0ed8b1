#pragma once

#include <string>
#include <vector>

#include "tools/plant_emulator/emulator_config.h"

namespace contour {

/// The axis with assignments on top, as `--set` takes them below `emulator.axes.<name>.`. Throws ConfigError
/// when one of them has no such form, names no key or is out of its range.
EmulatedAxisConfig Assigned(const EmulatedAxisConfig& axis, const std::vector<std::string>& assignments);

}  // namespace contour
