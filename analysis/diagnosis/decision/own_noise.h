#pragma once

#include <vector>

#include "analysis/diagnosis/decision/hypothesis.h"

namespace contour::diagnosis {

/// Learns the noise as the likeliest of the hypotheses leaves it, which comes to the front: of the best and
/// of those near it, beyond chance. Where an effect shows, the residual without it stands out, and what
/// stands out counts less: noise that is learnt with a wrong effect hides the right one and speaks for
/// itself. Likelihoods compare where each has the noise that it leaves. Sorted before.
void LearnNoiseOfLikeliest(Problem& problem, std::vector<Hypothesis>& hypotheses);

}  // namespace contour::diagnosis
