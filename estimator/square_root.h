#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

/// Square-root covariances of fixed size: P = S S^T with S lower triangular. No allocation, no exception.
namespace contour {

template <std::size_t N>
using StateVector = std::array<double, N>;

/// N x N, row by row. A square root keeps zeros above its diagonal.
template <std::size_t N>
using SquareMatrix = std::array<std::array<double, N>, N>;

/// Which states an update may move; the others keep their value, and their covariance is kept honest.
template <std::size_t N>
using StateMask = std::array<bool, N>;

namespace square_root {

/// Square root at compile time (Newton's iteration).
constexpr double Sqrt(double x) noexcept {
  if (x <= 0.0) return 0.0;
  double r = x > 1.0 ? x : 1.0;
  for (int i = 0; i < 64; ++i) r = 0.5 * (r + x / r);
  return r;
}

/// Scalar product with four partial sums: the order of additions is stated, so it vectorises without
/// fast-math and gives the same result on every machine.
template <std::size_t K>
inline double Dot(const double* a, const double* b) noexcept {
  double s0 = 0.0, s1 = 0.0, s2 = 0.0, s3 = 0.0;
  std::size_t k = 0;
  for (; k + 4 <= K; k += 4) {
    s0 += a[k] * b[k];
    s1 += a[k + 1] * b[k + 1];
    s2 += a[k + 2] * b[k + 2];
    s3 += a[k + 3] * b[k + 3];
  }
  for (; k < K; ++k) s0 += a[k] * b[k];
  return (s0 + s2) + (s1 + s3);
}

/// Lower-triangular S with S S^T = A A^T for A = [D, diag(q)], where D (N rows, M columns) holds weighted
/// deviations and q the square root of a diagonal noise covariance. Householder reflections from the right
/// (the paper's QR of A^T; S is the transpose of its upper factor).
///
/// Row i of A is stored with its noise entry at column M + i. The reflection that clears row i to the right
/// of its diagonal then reaches exactly columns i .. M + i: columns further right are still zero in row i,
/// and the reach is the same M + 1 for every row, so every loop has a length known at compile time.
template <std::size_t N, std::size_t M>
class Triangulariser {
 public:
  static constexpr std::size_t kWidth = M + N;

  /// Row i: deviations in 0 .. M-1, noise at M + i; everything else zero. Destroyed by Run.
  std::array<std::array<double, kWidth>, N> row{};

  void SetNoise(const StateVector<N>& noise) noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = M; k < kWidth; ++k) row[i][k] = 0.0;
      row[i][M + i] = noise[i];
    }
  }

  void Run(SquareMatrix<N>& s) noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      double* v = row[i].data() + i;
      const double squared = Dot<kReach>(v, v);
      const double norm = std::sqrt(squared);
      // Diagonals come out positive: the reflected row is +norm e_i, with v = row - norm e_i computed without
      // cancellation (v0 = x0 - norm = -(|x|^2 - x0^2) / (x0 + norm) when x0 > 0).
      const double x0 = v[0];
      double v0 = x0 - norm;
      if (x0 > 0.0) v0 = -Dot<kReach - 1>(v + 1, v + 1) / (x0 + norm);
      s[i][i] = norm;
      // Reflection I - v v^T / (norm (norm - x0)) = I + v v^T / (norm v0); nothing to do when v = 0.
      const double scale = norm * v0;
      const double factor = scale != 0.0 ? 1.0 / scale : 0.0;
      v[0] = v0;
      for (std::size_t j = i + 1; j < N; ++j) {
        double* a = row[j].data() + i;
        const double t = Dot<kReach>(v, a) * factor;
        for (std::size_t k = 0; k < kReach; ++k) a[k] += t * v[k];
        s[j][i] = a[0];
        s[i][j] = 0.0;
      }
    }
  }

 private:
  static constexpr std::size_t kReach = M + 1;
};

/// S S^T + w w^T by Givens rotations; w[0 .. first-1] must be zero. Destroys w. Cannot fail.
template <std::size_t N>
inline void AddRankOne(SquareMatrix<N>& s, StateVector<N>& w, std::size_t first) noexcept {
  for (std::size_t i = first; i < N; ++i) {
    const double r = std::sqrt(s[i][i] * s[i][i] + w[i] * w[i]);
    if (!(r > 0.0)) continue;
    const double c = s[i][i] / r;
    const double d = w[i] / r;
    for (std::size_t j = i; j < N; ++j) {
      const double sji = s[j][i];
      s[j][i] = c * sji + d * w[j];
      w[j] = c * w[j] - d * sji;
    }
  }
}

/// True when every state and every entry of S is finite and no variance exceeds its limit.
template <std::size_t N>
inline bool Sound(const StateVector<N>& x, const SquareMatrix<N>& s,
                  const StateVector<N>& std_limit) noexcept {
  bool ok = true;
  for (std::size_t i = 0; i < N; ++i) {
    double variance = 0.0;
    for (std::size_t j = 0; j <= i; ++j) variance += s[i][j] * s[i][j];
    // Comparisons are false for NaN.
    ok = ok && std::abs(x[i]) < std::numeric_limits<double>::max() && variance <= std_limit[i] * std_limit[i];
  }
  return ok;
}

}  // namespace square_root
}  // namespace contour
