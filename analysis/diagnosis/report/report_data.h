#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "analysis/diagnosis/report/report.h"

namespace contour::diagnosis {

/// report_data.json: words, candidates, blocks, base parameters, shapes, and which signals report_traces.bin
/// holds (64-bit floats, signal after signal).
void WriteReportData(const std::filesystem::path& dir, const AxisLog& log, const StatedAxis& stated,
                     const Diagnosis& found, const std::string& extended_model,
                     const std::optional<ContourGain>& contour);

}  // namespace contour::diagnosis
