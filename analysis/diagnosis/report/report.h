#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/diagnosis/report/contour_gain.h"
#include "analysis/diagnosis/result/finding.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// Writes `dir`/report.html, one page with everything in it, and the pictures next to it: the data first
/// (report_data.json, report_traces.bin), then tools/plots/plot_diagnosis.py draws them. Throws
/// std::runtime_error when a file cannot be written, EnvironmentError when Python cannot draw.
void WriteReport(const std::filesystem::path& dir, const AxisLog& log, const StatedAxis& stated,
                 const Diagnosis& found, const std::string& extended_model,
                 const std::optional<ContourGain>& contour = {});

}  // namespace contour::diagnosis
