#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "analysis/diagnosis/result/finding.h"
#include "tools/validation/hidden/judge.h"
#include "tools/validation/hidden/recorded_case.h"

namespace contour::hidden {

/// What became of a recorded case.
struct Outcome {
  KnownCase known;
  double false_alarm_rate = 0.05;
  Judged judged;
  diagnosis::Verdict verdict = diagnosis::Verdict::kInsufficientData;
  bool named = false;  ///< some cause was accepted
  double threshold = 0.0;
  double diagnose_s = 0.0;  ///< processor time of the diagnosis
  double log_s = 0.0;
};

using Diagnoser =
    std::function<diagnosis::Diagnosis(const diagnosis::AxisLog&, const diagnosis::StatedAxis&, double rate)>;

/// Has the case of that directory diagnosed, and judges. Throws std::runtime_error when its files are
/// missing.
Outcome AskCase(const std::filesystem::path& directory, const Diagnoser& diagnoser, double false_alarm_rate);

/// One line of results.csv, with a header when the file is new. Throws std::runtime_error.
void AppendCsv(const std::filesystem::path& file, const Outcome& outcome);

/// A line for each true parameter, with what is told of it.
void AppendSizes(const std::filesystem::path& file, const Outcome& outcome);

/// All lines of results.csv; none when there is no file. Throws std::runtime_error when it is of another
/// form.
std::vector<Outcome> ReadCsv(const std::filesystem::path& file);

}  // namespace contour::hidden
