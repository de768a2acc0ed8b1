#pragma once

#include "analysis/diagnosis/decision/accepted.h"
#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// What goes into a file: the model with all that has a name, and how good it is. `nominal`: without the
/// causes, `all`: with them. `something_left`: the residual has structure, so the model is a compromise; then
/// it is the one that foresees free runs, where they confirm it on what they have not seen.
void DescribeModel(const Problem& problem, const Fit& nominal, const Fit& all, const Accepted& accepted,
                   bool something_left, Diagnosis& out);

}  // namespace contour::diagnosis
