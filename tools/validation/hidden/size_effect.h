#pragma once

#include <filesystem>
#include <optional>

#include "tools/validation/hidden/hidden_case.h"

namespace contour::hidden {

/// Sizes an effect so that it makes the stated share of the residual's variance, by running the clean machine
/// and the one with the effect and closing in. None when even the largest sensible size stays below.
std::optional<Hidden> SizeEffect(const Setting& setting, Hidden effect, Strength strength,
                                 const std::filesystem::path& directory);

}  // namespace contour::hidden
