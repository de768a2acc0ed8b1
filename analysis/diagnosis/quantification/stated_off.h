#pragma once

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// Notes the numbers of the model that the log puts where no chance of their stated uncertainty does.
void TellStatedOff(const Problem& problem, const Point& fitted, Diagnosis& out);

}  // namespace contour::diagnosis
