#pragma once

#include <vector>

#include "analysis/prediction_error/fit.h"
#include "analysis/rough_fit/rough_fit.h"

namespace contour::diagnosis {

/// A fit from the stated numbers and one from those of least squares. A model that lacks something keeps a
/// fit where it began: the noise that is learnt there takes what is missing for its own.
struct TwoStarts {
  Fit fit;                    ///< the problem holds its noise
  std::vector<double> sigma;  ///< of its base terms, by what the parts of the log say too; of one start 0
  std::vector<double> apart;  ///< of the other end, where that is further than the deviations of both; else 0
};

/// The end that is lower under the noise of either is the answer; where each is the lower under its own, the
/// one that owes nothing to the stated numbers. Without least squares there is one start.
TwoStarts FitFromTwoStarts(Problem& problem, const RoughFit& rough);

/// Of every base term, by the sums of the gradient over parts of the log: a residual with a structure has
/// larger ones than its variance says.
std::vector<double> DeviationsByParts(const Problem& problem, const Fit& fit);

/// [deviations] From where two estimates are not of one number.
inline constexpr double kDisagree = 4.0;

/// Whether least squares say anything to compare with.
bool SaysEnough(const RoughFit& rough);

}  // namespace contour::diagnosis
