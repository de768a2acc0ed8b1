#pragma once

#include "analysis/diagnosis/decision/accepted.h"
#include "analysis/diagnosis/screening/nominal.h"

namespace contour::diagnosis {

/// Rounds of screening and decision: each looks for what the model lacks in addition to what is accepted
/// already, fits the best of it and accepts one cause, until none holds. Fills causes, candidates and what
/// could have been found in `out`. `stopped`: because there were as many as asked for.
struct RoundsResult {
  Accepted accepted;
  bool stopped = false;
};
RoundsResult AcceptInRounds(Problem& problem, const Nominal& nominal, const DiagnoseOptions& options,
                            Diagnosis& out);

}  // namespace contour::diagnosis
