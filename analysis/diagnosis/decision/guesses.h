#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/diagnosis/decision/hypothesis.h"
#include "analysis/diagnosis/decision/score_threshold.h"

namespace contour::diagnosis {

/// The effort of a fit that ends where a step gains less than a share of what it is below `current`.
FitEffort WorthFrom(const Fit& current, FitEffort effort, double share);

/// From the linear estimate.
InitialGuess Near(const Problem& problem, const Fit& current, const Scored& s);

/// Of a kind, what no fit leads from one to the other.
std::string FamilyOf(const Effect& effect);
bool Among(const std::vector<std::string>& families, const Scored& s);

/// Where fits of the best candidates begin that have not been tried; none where nothing beyond the threshold
/// is promised. `most`: the drop that the best of them is promised.
std::vector<InitialGuess> NextGuesses(const Problem& problem, const Fit& current,
                                      const std::vector<Scored>& scored, const ScoreThreshold& threshold,
                                      std::vector<std::string>& tried, double& most);

/// For fits that ended at shapes that no machine has: from the next place of their family's grid. Under noise
/// learnt without it a cause that is there may look more bent than it is.
std::vector<InitialGuess> OtherPlaces(const Problem& problem, const Fit& current,
                                      const std::vector<Scored>& scored,
                                      std::span<const Hypothesis> hypotheses);

/// For couplings that were fitted with a resonance below half the rate of the rows: from the one above half
/// the rate of which that resonance is the image (aliasing).
std::vector<InitialGuess> Mirrored(const Problem& problem, const Fit& current,
                                   const std::vector<Scored>& scored, std::span<const Hypothesis> hypotheses);

}  // namespace contour::diagnosis
