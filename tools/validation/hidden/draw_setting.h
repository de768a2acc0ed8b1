#pragma once

#include <string>
#include <vector>

#include "tools/validation/hidden/hidden_case.h"

namespace contour::hidden {

/// Draws machine, model and excitation from the seed; `kinds` decide only what must be there for them to
/// show. No kind: a clean machine. Throws std::runtime_error when the kinds cannot stand together on one
/// machine.
Setting DrawSetting(std::uint64_t seed, const std::vector<std::string>& kinds, Misfit misfit = Misfit::kNone,
                    Length length = Length::kLong);

/// An effect of that kind with everything but its size, and a size to begin with.
Hidden DrawEffect(std::uint64_t seed, const std::string& kind, const Setting& setting);

}  // namespace contour::hidden
