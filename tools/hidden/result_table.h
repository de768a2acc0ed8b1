#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/hidden/run_case.h"

namespace contour::hidden {

/// One line of results.csv, with a header when the file is new. Throws std::runtime_error.
void AppendCsv(const std::filesystem::path& file, const Outcome& outcome);

/// The table, as Markdown. `command` is what made it.
std::string ResultTable(const std::vector<Outcome>& outcomes, const std::string& command);

/// What DIAGNOSIS calls undecidable: not counted against a diagnoser.
bool Undecidable(const Outcome& outcome);

}  // namespace contour::hidden
