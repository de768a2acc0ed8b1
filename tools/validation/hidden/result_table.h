#pragma once

#include <string>
#include <vector>

#include "tools/validation/hidden/outcome.h"

namespace contour::hidden {

/// The table, as Markdown. `command` is what made it.
std::string ResultTable(const std::vector<Outcome>& outcomes, const std::string& command);

/// What DIAGNOSIS calls undecidable: not counted against a diagnoser.
bool Undecidable(const Outcome& outcome);

}  // namespace contour::hidden
