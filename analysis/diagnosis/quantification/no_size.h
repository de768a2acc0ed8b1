#pragma once

#include "analysis/diagnosis/decision/accepted.h"

namespace contour::diagnosis {

/// Marks causes whose size ended at a bound of what is allowed, of which the log says nothing: the interval
/// reaches the other bound, or holds zero. Their intervals stand in `out`.
void MarkNoSize(const Problem& problem, const Fit& fit, const Accepted& accepted, Diagnosis& out);

}  // namespace contour::diagnosis
