#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
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

/// Two neighbours at a time: the baseline has registers of 16 bytes.
using Pair = double __attribute__((vector_size(16)));

inline Pair Load(const double* p) noexcept {
  Pair v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void Store(double* p, Pair v) noexcept { std::memcpy(p, &v, sizeof v); }

/// Four neighbours: two registers of the baseline, one where there is AVX2. Only ever a local variable of
/// something inlined, since how it would be passed depends on the processor.
using Quad = double __attribute__((vector_size(32)));

/// Scalar product with four partial sums: the order of additions is stated, so the result is the same on
/// every machine.
template <std::size_t K>
[[gnu::always_inline]] inline double Dot(const double* a, const double* b) noexcept {
  Quad sums{};
  std::size_t k = 0;
  for (; k + 4 <= K; k += 4) {
    Quad u, v;
    std::memcpy(&u, a + k, sizeof u);
    std::memcpy(&v, b + k, sizeof v);
    sums += u * v;
  }
  Pair s{sums[0], sums[1]};
  const Pair t{sums[2], sums[3]};
  if (k + 2 <= K) {
    s += Load(a + k) * Load(b + k);
    k += 2;
  }
  s += t;
  double sum = s[0] + s[1];
  if (k < K) sum += a[k] * b[k];
  return sum;
}

/// a += t v.
template <std::size_t K>
[[gnu::always_inline]] inline void AddScaled(double* a, double t, const double* v) noexcept {
  const Quad four{t, t, t, t};
  const Pair tt{t, t};
  std::size_t k = 0;
  for (; k + 4 <= K; k += 4) {
    Quad u, w;
    std::memcpy(&u, a + k, sizeof u);
    std::memcpy(&w, v + k, sizeof w);
    u += four * w;
    std::memcpy(a + k, &u, sizeof u);
  }
  for (; k + 2 <= K; k += 2) Store(a + k, Load(a + k) + tt * Load(v + k));
  if (k < K) a[k] += t * v[k];
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
  std::array<std::array<double, kWidth>, N> row;

  [[gnu::always_inline]] void SetNoise(const StateVector<N>& noise) noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = M; k < kWidth; ++k) row[i][k] = 0.0;
      row[i][M + i] = noise[i];
    }
  }

  [[gnu::always_inline]] void Run(SquareMatrix<N>& s) noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      double* v = row[i].data() + i;
      const double x0 = v[0];
      const double rest = Dot<kReach - 1>(v + 1, v + 1);
      if (rest < kNothing) {
        // Row i is clear already, but for what would only underflow: at most a change of sign.
        const double sign = x0 < 0.0 ? -1.0 : 1.0;
        s[i][i] = sign * x0;
        for (std::size_t j = i + 1; j < N; ++j) {
          s[j][i] = sign * row[j][i];
          s[i][j] = 0.0;
        }
        continue;
      }
      const double norm = std::sqrt(x0 * x0 + rest);
      // Diagonals come out positive: the reflected row is +norm e_i. v0 = x0 - norm without cancellation.
      const double v0 = x0 > 0.0 ? -rest / (x0 + norm) : x0 - norm;
      s[i][i] = norm;
      // Reflection I - v v^T / (norm (norm - x0)) = I + v v^T / (norm v0).
      const double factor = 1.0 / (norm * v0);
      v[0] = v0;
      for (std::size_t j = i + 1; j < N; ++j) {
        double* a = row[j].data() + i;
        const double t = Dot<kReach>(v, a) * factor;
        AddScaled<kReach>(a, t, v);
        s[j][i] = a[0];
        s[i][j] = 0.0;
      }
    }
  }

 private:
  static constexpr std::size_t kReach = M + 1;
  static constexpr double kNothing = 1e-250;  // squared: entries below 1e-125 in any unit
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
