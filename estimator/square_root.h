#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/wide_numbers.h"

/// Square-root covariances of fixed size: P = S S^T with S lower triangular. No allocation, no exception.
namespace contour {

template <std::size_t N>
using StateVector = std::array<double, N>;

/// N x N, row by row. A square root keeps zeros above its diagonal, and in the element that fills an odd row
/// up to a whole number of registers.
template <std::size_t N>
using SquareMatrix = std::array<std::array<double, N + N % 2>, N>;

/// Which states an update may move; the others keep their value, and their covariance is kept honest.
template <std::size_t N>
using StateMask = std::array<bool, N>;

namespace square_root {

using wide::Load;
using wide::Pair;
using wide::Quad;
using wide::Store;

/// Square root at compile time (Newton's iteration).
constexpr double Sqrt(double x) noexcept {
  if (x <= 0.0) return 0.0;
  double r = x > 1.0 ? x : 1.0;
  for (int i = 0; i < 64; ++i) r = 0.5 * (r + x / r);
  return r;
}

/// Sum of the four, halves first.
[[gnu::always_inline]] inline double Fold(const Quad& q) noexcept {
  const Pair halves = Pair{q[0], q[1]} + Pair{q[2], q[3]};
  return halves[0] + halves[1];
}

/// Scalar product with four partial sums: the order of additions is stated, so the result is the same on
/// every machine.
template <std::size_t K>
[[gnu::always_inline]] inline double Dot(const double* a, const double* b) noexcept {
  Quad sums{};
  std::size_t k = 0;
  for (; k + 4 <= K; k += 4) {
    Quad u, v;
    Load(a + k, u);
    Load(b + k, v);
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

/// Lower-triangular S with S S^T = A A^T for A = [D, diag(q)], where D (N rows, M columns) holds weighted
/// deviations and q the square root of a diagonal noise covariance. Householder reflections from the right
/// (the paper's QR of A^T; S is the transpose of its upper factor).
///
/// The noise column of state i is column M + i. The reflection that clears row i to the right of its diagonal
/// then reaches exactly columns i .. M + i: columns further right are still zero in row i. Column c stands at
/// place c modulo kWidth: as reflection i is over, column i is done with, and the noise column that comes in
/// next takes its place. So every reflection works on the same places, whole registers from the first to the
/// last, and what one has stored is what the next one loads.
template <std::size_t N, std::size_t M>
class Triangulariser {
 public:
  static constexpr std::size_t kWidth = (M + 1 + 3) / 4 * 4;

  /// Row i: deviations in 0 .. M-1, zeros beyond. Destroyed by Run.
  alignas(32) std::array<std::array<double, kWidth>, N> row;

  [[gnu::always_inline]] void Run(const StateVector<N>& noise, SquareMatrix<N>& s) noexcept {
    Run(noise, s, std::make_index_sequence<N>{});
  }

 private:
  template <std::size_t... I>
  [[gnu::always_inline]] void Run(const StateVector<N>& noise, SquareMatrix<N>& s,
                                  std::index_sequence<I...>) noexcept {
    (Reflect<I>(noise[I], s), ...);
  }

  template <std::size_t I>
  [[gnu::always_inline]] void Reflect(double noise, SquareMatrix<N>& s) noexcept {
    constexpr std::size_t kPivot = I % kWidth;
    double* v = row[I].data();
    Set<(M + I) % kWidth>(v, noise);
    const double x0 = v[kPivot];
    Clear<kPivot>(v);
    const double rest = Product(v, v);
    for (std::size_t k = I + 1; k < s[I].size(); ++k) s[I][k] = 0.0;
    const double sign = std::copysign(1.0, x0);
    if (rest < kNothing) {
      // Row i is clear already, but for what would only underflow: at most a change of sign.
      s[I][I] = sign * x0;
      for (std::size_t j = I + 1; j < N; ++j) {
        s[j][I] = sign * row[j][kPivot];
        Clear<kPivot>(row[j].data());
      }
      return;
    }
    // v0 = x0 + sign norm does not cancel, and takes row i to -sign norm e_i; the column's sign is turned
    // after that: diagonals come out positive. Reflection I - v v^T / (norm (norm + |x0|)).
    const double square = x0 * x0 + rest;
    const double norm = std::sqrt(square);
    Set<kPivot>(v, x0 + sign * norm);
    const double factor = -1.0 / (square + std::abs(x0) * norm);
    s[I][I] = norm;
    for (std::size_t j = I + 1; j < N; ++j) {
      double* a = row[j].data();
      const double t = Product(v, a) * factor;
      AddScaled(a, t, v);
      s[j][I] = -sign * a[kPivot];
      Clear<kPivot>(a);
    }
  }

  using Lanes = long long __attribute__((vector_size(32)));

  /// One number, as part of the register that it belongs to: a register cannot be loaded at once from where a
  /// single number was just stored.
  template <std::size_t Place>
  [[gnu::always_inline]] static void Set(double* v, double x) noexcept {
    constexpr std::size_t k = Place % 4;
    Quad q;
    Load(v + Place / 4 * 4, q);
    q = __builtin_shufflevector(q, Quad{x, x, x, x}, k == 0 ? 4 : 0, k == 1 ? 5 : 1, k == 2 ? 6 : 2,
                                k == 3 ? 7 : 3);
    Store(v + Place / 4 * 4, q);
  }

  template <std::size_t Place>
  [[gnu::always_inline]] static void Clear(double* v) noexcept {
    constexpr std::size_t k = Place % 4;
    Quad q;
    Load(v + Place / 4 * 4, q);
    q = reinterpret_cast<Quad>(reinterpret_cast<Lanes>(q) &
                               Lanes{k == 0 ? 0 : -1, k == 1 ? 0 : -1, k == 2 ? 0 : -1, k == 3 ? 0 : -1});
    Store(v + Place / 4 * 4, q);
  }

  /// Scalar product; the order of additions is stated, so the result is the same on every machine.
  [[gnu::always_inline]] static double Product(const double* u, const double* v) noexcept {
    Quad even{}, odd{};
    for (std::size_t k = 0; k < kWidth; k += 4) {
      Quad a, b;
      Load(u + k, a);
      Load(v + k, b);
      a *= b;
      if (k == 0)
        even = a;
      else if (k == 4)
        odd = a;
      else if (k % 8 == 0)
        even += a;
      else
        odd += a;
    }
    even += odd;
    return Fold(even);
  }

  /// a += t v.
  [[gnu::always_inline]] static void AddScaled(double* a, double t, const double* v) noexcept {
    const Quad four{t, t, t, t};
    for (std::size_t k = 0; k < kWidth; k += 4) {
      Quad u, w;
      Load(a + k, u);
      Load(v + k, w);
      u += four * w;
      Store(a + k, u);
    }
  }

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
    const double variance = Dot<N + N % 2>(s[i].data(), s[i].data());
    // Comparisons are false for NaN.
    ok = ok && std::abs(x[i]) < std::numeric_limits<double>::max() && variance <= std_limit[i] * std_limit[i];
  }
  return ok;
}

}  // namespace square_root
}  // namespace contour
