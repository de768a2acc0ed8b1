#include "design/spectral_radius.h"

#include <cmath>
#include <limits>

namespace contour {
namespace {

// The norm of A^N to the power of 1 / N, at N = 2^20: what the norm has beyond the radius is down to a part
// in 1e5 where it is a million times as much. A search for loops asks for thousands of radii and for nothing
// else of the eigenvalues, which take two to three times as long.
constexpr int kSquarings = 20;

}  // namespace

double SpectralRadius(const LoopMatrix& matrix, double below) {
  LoopMatrix power = matrix, squared(matrix.rows(), matrix.cols());
  double log_radius = 0.0, share = 1.0;
  for (int i = 0; i <= kSquarings; ++i, share *= 0.5) {
    const double norm = power.norm();
    if (!std::isfinite(norm)) return std::numeric_limits<double>::infinity();
    if (norm == 0.0) return 0.0;
    log_radius += share * std::log(norm);  // of a bound from above
    if (below > 0.0 && log_radius < std::log(below)) break;
    power /= norm;
    squared.noalias() = power * power;
    power.swap(squared);
  }
  return std::exp(log_radius);
}

}  // namespace contour
