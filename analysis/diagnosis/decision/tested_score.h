#pragma once

#include "analysis/diagnosis/decision/hypothesis.h"
#include "analysis/diagnosis/decision/score_threshold.h"

namespace contour::diagnosis {

/// Whether it gives a model that is stated as rigid a coupling.
bool AddsCoupling(const Problem& problem, const Hypothesis& r);

/// Scores a hypothesis from its fit, and says whether it is a coupling that every screw has.
void Judge(const Problem& problem, const Fit& current, Hypothesis& r);

/// Whether the score test promises something beyond the threshold.
bool Promising(const Problem& problem, const Scored& s, ScoreThreshold threshold);

/// Of a hypothesis, what the threshold asks about: the drop of the joint fit, but not more than the score
/// test at its own place promises (a cost that is a little rough has low points by chance), over the
/// overdispersion of what is left.
double TestedScore(const Problem& problem, const Fit& current, const Hypothesis& hypothesis);

}  // namespace contour::diagnosis
