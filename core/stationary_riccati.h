#pragma once

#include <Eigen/Dense>
#include <optional>

// For construction and for design offline; the cycle has no use for it.
namespace contour {

/// Small matrices of a size known when they are made; they live on the stack.
inline constexpr int kMostLoopStates = 16;
using SmallMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostLoopStates, kMostLoopStates>;

/// The stabilising solution X of X = A' X A - A' X B (R + B' X B)^-1 B' X A + Q, by structured doubling
/// (Chu, Fan, Lin, Wang, Int. J. Control 77(8), 2004): each pass squares the closed loop, so it takes about
/// ten. A n x n, B n x m, Q n x n and not negative, R m x m and positive. Nothing when it does not converge:
/// some mode cannot be reached or does not show.
std::optional<SmallMatrix> SolveRiccati(const SmallMatrix& a, const SmallMatrix& b, const SmallMatrix& q,
                                        const SmallMatrix& r);

}  // namespace contour
