#pragma once

#include "analysis/axis_model/stated_axis.h"
#include "analysis/diagnosis/result/diagnose_options.h"
#include "analysis/diagnosis/result/finding.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// What the log shows that the model does not have. The log's columns must be of equal length, its period and
/// the stated inertia positive: std::invalid_argument otherwise.
Diagnosis Diagnose(const AxisLog& log, const StatedAxis& stated, const DiagnoseOptions& options = {});

}  // namespace contour::diagnosis
