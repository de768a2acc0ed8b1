#pragma once

#include <span>
#include <string>

#include "core/cycle_record.h"

namespace contour {

/// What a stop or fault means and what to do about it, one sentence; empty for Reason::kNone.
std::string ReasonText(const CycleRecord& record, std::span<const std::string> axis_names,
                       std::span<const std::string> bus_names);

/// Why a request is refused in this state; for people.
std::string RefusalText(const CycleRecord& record, RequestKind request,
                        std::span<const std::string> axis_names, std::span<const std::string> bus_names);

}  // namespace contour
