#pragma once

#include <string>
#include <vector>

#include "analysis/diagnosis/decision/score_threshold.h"
#include "analysis/diagnosis/screening/score.h"
#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// A candidate hypothesis, fitted jointly with the base and with what is accepted already.
struct Hypothesis {
  Fit fit;
  double score = 0.0;    ///< what it lowers chi^2 and prior by, less its penalty
  bool refused = false;  ///< did not hold
  /// So far behind that nothing but its place and its score is kept: the rest of a fit is large.
  bool given_up = false;
  /// A coupling that every screw has, no cause of a deviation: it belongs to the base.
  bool no_fault = false;

  [[nodiscard]] const Effect& effect() const { return *fit.point.effects.back(); }
};

bool Outside(const std::string& kind);

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

/// Under noise learnt since: the base, and the hypotheses, those that may still win fitted anew.
void FitAgain(const Problem& problem, Fit& current, std::vector<Hypothesis>& hypotheses);

/// Of a hypothesis, what the threshold asks about: the drop of the joint fit, but not more than the score
/// test at its own place promises (a cost that is a little rough has low points by chance), over the
/// overdispersion of what is left.
double TestedScore(const Problem& problem, const Fit& current, const Hypothesis& hypothesis);

}  // namespace contour::diagnosis
