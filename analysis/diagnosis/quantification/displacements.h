#pragma once

#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// A note where the position jumps within one row and stays away: rows that were left out as outliers, after
/// which the position goes on from the new place. Further than the log's largest command, friction and
/// constant force move the axis in that time, and far beyond what other rows do. A wrong reading of some rows
/// is back after them, and one that was held has nothing to make up for.
void TellDisplacements(const Problem& problem, const Point& fitted, Diagnosis& out);

}  // namespace contour::diagnosis
