#pragma once

#include <span>

#include "analysis/prediction_error/kalman_pass.h"

namespace contour::diagnosis {

/// A single reading counts in the likelihood as if it were off by at most so many of the others' variances.
inline constexpr double kMostSquare = 100.0;

/// What a pass of the Kalman filter adds to the sums for each of at most kLanes noises of one reading, side
/// by side. They differ from those of KalmanPass by rounding.
void AddLikelihoods(const PassRows& rows, std::span<const NoiseVariances> noises,
                    std::span<LikelihoodSums> sums);

}  // namespace contour::diagnosis
