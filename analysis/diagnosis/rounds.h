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
  /// Where a shape from outside the catalogue came first: the known causes that explain the most in its
  /// place, each with its size and gain.
  std::vector<Cause> leading = {};
};
RoundsResult AcceptInRounds(Problem& problem, const Nominal& nominal, const DiagnoseOptions& options,
                            Diagnosis& out);

}  // namespace contour::diagnosis
