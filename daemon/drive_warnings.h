#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/cycle_record.h"

namespace contour {

/// A sentence for each axis whose drive sets bit 7 of its statusword: something that is no fault yet. A drive
/// that gets too hot, for one, says so some time before it trips.
std::vector<std::string> DriveWarnings(const CycleRecord& record, std::span<const std::string> axis_names);

}  // namespace contour
