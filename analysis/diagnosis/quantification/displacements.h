#pragma once

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// A note where the position jumps within one row and stays away, further than the log's largest command
/// moves the axis in that time: rows that were left out as outliers, after which the position goes on from
/// the new place. A wrong reading is back a row later.
void TellDisplacements(const Problem& problem, const Point& fitted, Diagnosis& out);

}  // namespace contour::diagnosis
