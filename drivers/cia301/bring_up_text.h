#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/cycle_record.h"

// Texts for people; not for the real-time side.
namespace contour {

/// One English sentence: where bringing up stands, or what failed on which node and object, what was
/// expected, what was found, how long it waited and what to look at. `axis_names` in the order of the machine
/// file.
[[nodiscard]] std::string BringUpText(const BringUpStatus& status, std::span<const std::string> axis_names);

/// What another master was seen by, when that is what failed; empty otherwise.
[[nodiscard]] std::string SecondMasterText(const BringUpStatus& status);

}  // namespace contour
