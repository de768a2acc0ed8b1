#pragma once

#include <filesystem>

#include "analysis/recording/axis_log.h"

namespace contour::hidden {

/// The log as a table (docs/diagnosis_files.md) whose numbers read back to the last bit: a tenth of the size
/// of a log of contourd. Throws std::runtime_error when it cannot be written, or the log has missing rows.
void WriteLogTable(const diagnosis::AxisLog& log, const std::filesystem::path& file);

}  // namespace contour::hidden
