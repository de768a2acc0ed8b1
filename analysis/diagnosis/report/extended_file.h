#pragma once

#include <string>

#include "analysis/diagnosis/result/finding.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// The model file anew, every line and comment kept, with the accepted causes under `extensions:` of the
/// model
/// (`axes.<axis>.model` of a machine file). Where the model is written in one line, or is another file, the
/// text is a model that stands alone, which a machine file can name. Empty when there is nothing to add, and
/// for linear axes, whose extensions no program uses.
std::string ExtendedFile(const std::string& file, const std::string& axis, const Diagnosis& found,
                         const AxisLog& log);

}  // namespace contour::diagnosis
