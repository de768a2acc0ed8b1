#pragma once

#include <optional>
#include <string>

#include "analysis/diagnosis/report/contour_gain.h"
#include "analysis/diagnosis/result/finding.h"

namespace contour::diagnosis {

/// "cause_found", "ambiguous", ...
std::string VerdictName(Verdict verdict);

/// diagnose.json: the verdict, the accepted causes, what could not be told, and the quality of the data.
/// `extended_model` is the file that holds the model with its causes; empty: none was written. Numbers that
/// are not finite become null.
std::string DiagnosisJson(const Diagnosis& diagnosis, const std::string& extended_model,
                          const std::optional<ContourGain>& contour = {});

}  // namespace contour::diagnosis
