#pragma once

#include <string>

#include "tools/hidden/hidden_case.h"

namespace contour::hidden {

/// The machine file: what the daemon runs with, and what the emulated machine is but for its effects.
std::string MachineText(const Setting& setting);

/// The model as the user states it to diagnosis.
std::string ModelText(const Setting& setting);

}  // namespace contour::hidden
