#pragma once

#include <string>
#include <vector>

#include "analysis/diagnosis/decision/hypothesis.h"
#include "analysis/diagnosis/decision/score_threshold.h"

namespace contour::diagnosis {

/// The best of each kind: some of the catalogue, and the best from outside it. The best of them first. None
/// where the score test promises nothing beyond the threshold. What was fitted is added to `tried`; what
/// stands there is not fitted again.
std::vector<Hypothesis> FitHypotheses(const Problem& problem, const Fit& current,
                                      const std::vector<Scored>& scored, const ScoreThreshold& threshold,
                                      std::vector<std::string>& tried);

/// Whether the score test promises something beyond the threshold that has not been tried.
bool MorePromised(const Problem& problem, const std::vector<Scored>& scored, const ScoreThreshold& threshold,
                  const std::vector<std::string>& tried);

/// Whether one of them comes near its threshold, or might after a few steps more.
bool MayHold(const Problem& problem, const std::vector<Hypothesis>& hypotheses,
             const ScoreThreshold& threshold);

/// Another turn for what was given up, or passed over, behind a best one that came to nothing since, where
/// its score says that it might hold: it is taken out of what was tried. What was refused is not.
void GiveAnotherTurn(const Problem& problem, const std::vector<Hypothesis>& hypotheses,
                     const ScoreThreshold& threshold, std::vector<std::string>& tried);

/// Under noise learnt since: the base, and the hypotheses, those that may still win fitted anew. Whether the
/// base was found to lie elsewhere, which is most of what the best hypothesis was to explain, be it the best
/// before or after.
bool FitAgain(const Problem& problem, Fit& current, std::vector<Hypothesis>& hypotheses);

}  // namespace contour::diagnosis
