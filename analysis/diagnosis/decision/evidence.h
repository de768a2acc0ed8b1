#pragma once

#include <vector>

#include "analysis/diagnosis/adequacy/remaining_structure.h"
#include "analysis/diagnosis/decision/accepted.h"

namespace contour::diagnosis {

// What calibrations are made from. Nothing is done where nobody asks.

/// Of every kind, what it scored in one round.
void TellEvidence(const Problem& problem, const Accepted& accepted, const std::vector<Scored>& scored,
                  const std::vector<Hypothesis>& hypotheses, const ScoreThreshold& threshold,
                  const DiagnoseOptions& options);

/// Of what is left at the end, the best of each class.
void TellStructure(const Accepted& accepted, const std::vector<RemainingStructure>& left,
                   const DiagnoseOptions& options);

}  // namespace contour::diagnosis
