#pragma once

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// Of a log without a position: how late its velocity comes, which is no cause.
void TellColumnLag(const Problem& problem, const Point& fitted, Diagnosis& out);

}  // namespace contour::diagnosis
