#pragma once

#include <vector>

#include "analysis/diagnosis/adequacy/remaining_structure.h"
#include "analysis/diagnosis/result/finding.h"

namespace contour::diagnosis {

/// From the causes that were accepted and from what they leave, the largest first: the verdict, and notes in
/// plain words. Where what is left exceeds what is asked of it and is a large part of all there is to
/// explain, causes are told as part of it, and none is the name of the deviation. No cause is told that does
/// harm on data that its fit has not seen.
void Conclude(const Problem& problem, const std::vector<RemainingStructure>& left, Diagnosis& out);

}  // namespace contour::diagnosis
