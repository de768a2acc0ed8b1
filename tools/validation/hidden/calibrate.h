#pragma once

#include <istream>
#include <string>

namespace contour::hidden {

/// From what `--fit-above-chance --evidence` wrote of machines without an effect, and of machines with one:
/// the lines of analysis/diagnosis/tuning/model_error_table.inc. Throws std::runtime_error where the table is
/// no such evidence or has no clean log.
std::string ModelErrorTable(std::istream& evidence);

}  // namespace contour::hidden
