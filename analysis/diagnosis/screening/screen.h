#pragma once

#include <span>
#include <vector>

#include "analysis/diagnosis/screening/score.h"

namespace contour::diagnosis {

/// All that may be tried in addition to a fit, the one that promises most first: the catalogue and the waves
/// that the scans propose, without what the fit has already.
std::vector<Scored> Screen(const Problem& problem, const Fit& fit, std::span<const SharedEffect> catalogue);

}  // namespace contour::diagnosis
