#pragma once

#include <string_view>
#include <vector>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"

// What changes while a log is recorded, and by how much.
namespace contour::diagnosis {

/// Of `kind`, a share of `input` that changes evenly over the log, or exponentially.
void Drifts(const Problem& problem, std::string_view kind, Input input, std::vector<SharedEffect>& out);

/// From the log's beginning to its end, over what it is at the beginning; with a time constant where it is
/// not even.
NamedValues ChangeOverLog(const FittedEffect& fitted);

}  // namespace contour::diagnosis
