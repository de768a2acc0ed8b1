#include "analysis/diagnosis/report/report.h"

#include "analysis/diagnosis/report/draw.h"
#include "analysis/diagnosis/report/report_data.h"

namespace contour::diagnosis {

void WriteReport(const std::filesystem::path& dir, const AxisLog& log, const StatedAxis& stated,
                 const Diagnosis& found, const std::string& extended_model,
                 const std::optional<ContourGain>& contour) {
  WriteReportData(dir, log, stated, found, extended_model, contour);
  Draw("plot_diagnosis.py", {dir.string()});
}

}  // namespace contour::diagnosis
