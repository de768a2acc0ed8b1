#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

/// Ends of blocks of time, the last one the number of rows. A block is one stroke from turn to turn, or
/// several short ones, or a part of a long one: what disturbs one stroke disturbs all of it.
std::vector<std::size_t> StrokeEnds(const Problem& problem);

/// Where the fit goes when what is left in each stroke comes anew at random: deviations of its parameters,
/// base terms first, one column per run. A score bootstrap by blocks (Kline and Santos, Journal of
/// Econometric Methods 1(1), 2012): each run multiplies the gradient of every stroke by a normal deviate,
/// draws the stated numbers from their priors, and takes two Gauss-Newton steps to where the gradient
/// balances them, the second from a run of the model where the first leads. The same seed gives the same
/// columns on any number of threads.
Eigen::MatrixXd StrokeBootstrap(const Problem& problem, const Fit& fit, int runs, std::uint64_t seed,
                                const std::function<void(double)>& progress = {});

}  // namespace contour::diagnosis
