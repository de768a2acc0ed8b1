#pragma once

#include <span>
#include <vector>

#include "analysis/diagnosis/decision/hypothesis.h"
#include "analysis/diagnosis/decision/score_threshold.h"

namespace contour::diagnosis {

/// For causes of when a torque begins to act: from so many rows later as the log likes best, where that
/// promises more than the threshold and none of the hypotheses came near. Next to none the numbers of the
/// base make up for a little delay, so that no fit leads from there to several rows.
std::vector<InitialGuess> LongDelays(const Problem& problem, const Fit& current,
                                     const std::vector<Scored>& scored, const ScoreThreshold& threshold,
                                     std::span<const Hypothesis> hypotheses);

}  // namespace contour::diagnosis
