#pragma once

#include <Eigen/Core>

namespace contour::diagnosis {

/// How much larger drops are by chance than white noise would make them, when blocks get random signs; at
/// least 1. `per_block`: gradients, one column a block; `covariance`: of the amplitudes, in white noise.
double WithinBlocks(const Eigen::MatrixXd& per_block, const Eigen::MatrixXd& covariance);

/// The same where blocks next to each other may go together: variance of a sum by Bartlett's window (Newey
/// and West, Econometrica 55, 1987), as many neighbours as the root of all.
double Overdispersion(const Eigen::MatrixXd& per_block, const Eigen::MatrixXd& covariance);

}  // namespace contour::diagnosis
