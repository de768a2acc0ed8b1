#pragma once

#include <string>

#include "analysis/diagnosis/result/finding.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// The model as the log has it: its numbers fitted, their deviations under `uncertainty:`, the causes that
/// were fitted with them under `extensions:`. A machine file keeps every other line and comment
/// (`axes.<axis>.model`); where its model is written in one line, or is another file, the text is a model
/// that stands alone, which a machine file can name. A model that stands alone is written anew. Empty when
/// there is nothing to say.
std::string ExtendedFile(const std::string& file, const std::string& axis, const Diagnosis& found,
                         const AxisLog& log);

}  // namespace contour::diagnosis
