#pragma once

#include "analysis/diagnosis/decision/hypothesis.h"

namespace contour::diagnosis {

/// Where a base lies that does without the last effect. What that has freed of the base stays where it is.
Point WithoutLast(const Problem& problem, Point point);

/// Whether a base that begins where the hypothesis lies ends so much lower than the one at hand that it
/// explains most of what the hypothesis was to explain; then it is the base.
bool BaseLiesThere(const Problem& problem, const Hypothesis& r, const FitEffort& effort, Fit& current);

}  // namespace contour::diagnosis
