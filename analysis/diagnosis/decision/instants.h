#pragma once

#include <span>
#include <vector>

#include "analysis/diagnosis/decision/hypothesis.h"

namespace contour::diagnosis {

/// For what begins at an instant inside the log: from where the rest of the fit would have it begin. Rows in
/// which the axis hardly accelerates tell no instant from the next, so a fit rests on the far side of them;
/// the instants are looked through from the whole reach down to a row.
std::vector<InitialGuess> OtherInstants(const Problem& problem, const Fit& current,
                                        std::span<const Hypothesis> hypotheses);

}  // namespace contour::diagnosis
