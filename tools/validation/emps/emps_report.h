#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace contour::emps {

struct ReportOptions {
  std::filesystem::path emps;  ///< directory with emps_train.csv and emps_pulses.csv
  std::filesystem::path out;   ///< directory for emps.md and its pictures, emps_*.png
  int threads = 1;
  std::function<void(std::string_view, double)> progress;
};

/// Whether the files are there.
bool HasRecordings(const std::filesystem::path& emps);

/// Writes emps.md: the authors' models scored, what diagnosis names unaided, and what each cause gains on
/// data the fit has not seen. Throws ConfigError for files that are not EMPS, std::runtime_error when nothing
/// can be written.
void WriteEmpsReport(const ReportOptions& options);

}  // namespace contour::emps
