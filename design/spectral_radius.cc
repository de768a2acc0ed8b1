#include "design/spectral_radius.h"

#include <cmath>
#include <limits>

namespace contour {
namespace {

// A search for loops asks of thousands of matrices whether their radius is below 1, and where it is, for
// nothing else. The norm of A^N to the power of 1 / N is above the radius for every N, and by little for a
// large one: some products of the matrix with itself are enough for most loops. For those that are unstable,
// or take thousands of cycles to settle, they are not, and the eigenvalues decide.
constexpr int kSquarings = 14;  // N = 16384 cycles

/// A bound from above that is smaller than `below`, or infinity where there is none.
double Bound(LoopMatrix power, double below) {
  LoopMatrix squared(power.rows(), power.cols());
  double log_bound = 0.0, share = 1.0;
  for (int i = 0; i <= kSquarings; ++i, share *= 0.5) {
    const double norm = power.norm();
    if (norm == 0.0) return 0.0;
    log_bound += share * std::log(norm);
    if (log_bound < std::log(below)) return std::exp(log_bound);
    power /= norm;
    squared.noalias() = power * power;
    power.swap(squared);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double SpectralRadius(const LoopMatrix& matrix, double below) {
  if (!std::isfinite(matrix.norm())) return std::numeric_limits<double>::infinity();
  if (below > 0.0)
    if (const double bound = Bound(matrix, below); bound < below) return bound;
  const Eigen::EigenSolver<LoopMatrix> solver(matrix, false);
  if (solver.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace contour
