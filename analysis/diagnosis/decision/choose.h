#pragma once

#include <vector>

#include "analysis/diagnosis/decision/hypothesis.h"
#include "analysis/diagnosis/decision/score_threshold.h"

namespace contour::diagnosis {

/// What a hypothesis's score must exceed.
double Asked(const Problem& problem, const Hypothesis& r, const ScoreThreshold& threshold);

/// Whether what speaks for an effect goes on doing so when another one is in the model: these two do not
/// explain the same. Of what a test for small sizes says something about.
bool ExplainsSomethingElse(const Problem& problem, const Fit& other, const Hypothesis& r);

struct Choice {
  bool found = false;   ///< the first of the hypotheses holds
  double tested = 0.0;  ///< its tested score; of the best where none holds
};

/// The best of the hypotheses, or the next that holds where the best does not, goes to their front. Those
/// that do not hold are marked as refused.
Choice ChooseFirst(const Problem& problem, const Fit& current, const ScoreThreshold& threshold,
                   std::vector<Hypothesis>& hypotheses);

}  // namespace contour::diagnosis
