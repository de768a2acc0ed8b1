#pragma once

#include "analysis/diagnosis/decision/accepted.h"
#include "analysis/diagnosis/decision/score_threshold.h"

namespace contour::diagnosis {

/// After a further cause was accepted: takes those before it out of the model and out of `out` that explain
/// no more than chance does with the new one in the model. They stood for it; the new one is told with the
/// evidence and the gain that it has in their place. Whether any went.
bool DropSuperseded(const Problem& problem, const ScoreThreshold& threshold, Accepted& accepted,
                    Diagnosis& out);

}  // namespace contour::diagnosis
