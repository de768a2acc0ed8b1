#pragma once

#include <bit>
#include <cstdint>

#include "core/wide_numbers.h"

/// exp and expm1 as plain arithmetic: loops over sigma points vectorise, and the result is the same on every
/// machine (the C library's picks other code where it finds FMA). Relative error below 4e-16.
namespace contour {

namespace exponential {

template <class T>
struct Reduced {
  T r;      ///< x - n ln 2, |r| <= ln 2 / 2
  T power;  ///< 2^n
};

/// Whole numbers as wide as T.
template <class T>
struct BitsOf;
template <>
struct BitsOf<double> {
  using Type = std::uint64_t;
};
template <>
struct BitsOf<wide::Pair> {
  using Type = std::uint64_t __attribute__((vector_size(16)));
};
template <>
struct BitsOf<wide::Quad> {
  using Type = std::uint64_t __attribute__((vector_size(32)));
};

/// |x| <= 700. By reference, as all that is meant for wide::Quad, too.
template <class T>
[[gnu::always_inline]] inline void Reduce(const T& x, Reduced<T>& out) noexcept {
  constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
  const T shifted = x * 1.4426950408889634 + kShift;
  const T n = shifted - kShift;
  // ln 2 in two parts, the first with 20 trailing zero bits, so that n * kHigh is exact.
  constexpr double kHigh = 6.93147180369123816490e-01;
  constexpr double kLow = 1.90821492927058770002e-10;
  out.r = (x - n * kHigh) - n * kLow;
  const auto bits = __builtin_bit_cast(typename BitsOf<T>::Type, shifted) << 52U;
  out.power = __builtin_bit_cast(T, bits + std::bit_cast<std::uint64_t>(1.0));
}

/// (exp(r) - 1) / r for |r| <= ln 2 / 2: the polynomial of degree 10 that is 1 at 0 and nearest to it at
/// Chebyshev's nodes (relative error of exp(r) - 1 below 5e-17; Taylor's series needs degree 12). Summed by
/// Estrin's scheme, which does not wait for one term after the other: exponentials follow one another in the
/// filter, and a third of the time goes.
template <class T>
[[gnu::always_inline]] inline void Series(const T& r, T& out) noexcept {
  const T r2 = r * r;
  const T r4 = r2 * r2;
  const T t0 = 1.0 + 0.5000000000000001 * r;
  const T t2 = 0.16666666666666669 + 0.04166666666662413 * r;
  const T t4 = 0.008333333333330062 + 0.0013888888917213717 * r;
  const T t6 = 0.00019841269863053618 + 2.4801521295954376e-05 * r;
  const T t8 = 2.7557268459997064e-06 + 2.7620088445409746e-07 * r;
  const T u0 = t0 + t2 * r2;
  const T u4 = t4 + t6 * r2;
  const T u8 = t8 + 2.510038549551032e-08 * r2;
  out = u0 + r4 * (u4 + r4 * u8);
}

/// For x <= 0, below -700 as at -700: exp(x) = power (1 + beyond_1).
template <class T>
[[gnu::always_inline]] inline void PartsOfNegative(const T& x, T& power, T& beyond_1) noexcept {
  const T lowest = T{} - 700.0;
  const T bounded = x < lowest ? lowest : x;
  Reduced<T> reduced;
  Reduce<T>(bounded, reduced);
  T series;
  Series<T>(reduced.r, series);
  power = reduced.power;
  beyond_1 = reduced.r * series;
}

}  // namespace exponential

/// exp(x) for x <= 0; below -700 as at -700. Half of the limits and most of their cost are not needed there.
/// T: double, or two or four of them side by side.
template <class T>
[[gnu::always_inline]] inline void ExpOfNegative(const T& x, T& out) noexcept {
  T power, beyond_1;
  exponential::PartsOfNegative<T>(x, power, beyond_1);
  out = power + power * beyond_1;
}
template <class T>
inline T ExpOfNegative(T x) noexcept {
  T out;
  ExpOfNegative<T>(x, out);
  return out;
}

/// exp(x) - 1 for x <= 0, without cancellation near zero.
template <class T>
[[gnu::always_inline]] inline void Expm1OfNegative(const T& x, T& out) noexcept {
  T power, beyond_1;
  exponential::PartsOfNegative<T>(x, power, beyond_1);
  out = power * beyond_1 + (power - 1.0);
}
inline double Expm1OfNegative(double x) noexcept {
  double out;
  Expm1OfNegative(x, out);
  return out;
}

/// Arguments beyond +-700 are taken as +-700.
inline double Exp(double x) noexcept { return ExpOfNegative(x > 700.0 ? 700.0 : x); }

/// exp(x) - 1 without cancellation near zero.
inline double Expm1(double x) noexcept { return Expm1OfNegative(x > 700.0 ? 700.0 : x); }

}  // namespace contour
