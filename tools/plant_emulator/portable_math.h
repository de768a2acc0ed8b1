#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

// Elementary functions that give the same bits on every host. The C library picks its exp and sin by the CPU
// it finds (with or without fused multiply-add), so its last bit differs between machines, and a friction
// simulation with stick and slip turns last bits into whole runs. Only additions, multiplications, divisions
// and roundings below.
namespace contour::portable {

/// e^x, relative error under 4e-16; 0 below -708, infinity above 709.
inline double Exp(double x) noexcept {
  if (x < -708.0) return 0.0;
  if (x > 709.0) return std::numeric_limits<double>::infinity();
  if (x != x) return x;
  constexpr double kLog2e = 1.44269504088896338700;
  constexpr double kLn2High = 6.93147180369123816490e-01;
  constexpr double kLn2Low = 1.90821492927058770002e-10;
  const double k = std::floor(x * kLog2e + 0.5);
  const double r = (x - k * kLn2High) - k * kLn2Low;
  // Taylor to r^13, |r| <= 0.347: truncated at 1e-17. Paired terms keep the dependency chain short.
  const double r2 = r * r;
  const double r4 = r2 * r2;
  const double a = 1.0 + r;
  const double b = 1.0 / 2 + r * (1.0 / 6);
  const double c = 1.0 / 24 + r * (1.0 / 120);
  const double d = 1.0 / 720 + r * (1.0 / 5040);
  const double e = 1.0 / 40320 + r * (1.0 / 362880);
  const double f = 1.0 / 3628800 + r * (1.0 / 39916800);
  const double g = 1.0 / 479001600 + r * (1.0 / 6227020800.0);
  const double p = (a + r2 * b) + r4 * ((c + r2 * d) + r4 * ((e + r2 * f) + r4 * g));
  const auto exponent = static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + 1023);
  return p * std::bit_cast<double>(exponent << 52);
}

/// Natural logarithm of a positive normal number, absolute error under 4e-16.
inline double Log(double x) noexcept {
  constexpr double kLn2 = 6.93147180559945286227e-01;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023);
  double m = std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFULL) | 0x3FF0000000000000ULL);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    exponent += 1.0;
  }
  const double s = (m - 1.0) / (m + 1.0);  // ln m = 2 artanh s, |s| <= 0.172
  const double s2 = s * s;
  double p = 1.0 / 21;
  for (int n = 19; n >= 1; n -= 2) p = p * s2 + 1.0 / n;
  return exponent * kLn2 + 2.0 * s * p;
}

/// x^y for x > 0.
inline double Pow(double x, double y) noexcept { return Exp(y * Log(x)); }

/// sin(x) for |x| up to 1e6, absolute error under 1e-15 (1e-10 at the far end).
inline double Sin(double x) noexcept {
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00;
  constexpr double kHalfPiLow = 6.07710050650619224932e-11;
  const double k = std::floor(x * kTwoOverPi + 0.5);
  const double r = (x - k * kHalfPiHigh) - k * kHalfPiLow;
  const double r2 = r * r;
  const auto quadrant = static_cast<std::int64_t>(k) & 3;
  double y = 0.0;
  if ((quadrant & 1) == 0) {
    y = r * (1.0 + r2 * (-1.0 / 6 +
                         r2 * (1.0 / 120 +
                               r2 * (-1.0 / 5040 + r2 * (1.0 / 362880 + r2 * (-1.0 / 39916800 +
                                                                              r2 * (1.0 / 6227020800.0)))))));
  } else {
    y = 1.0 +
        r2 * (-1.0 / 2 +
              r2 * (1.0 / 24 +
                    r2 * (-1.0 / 720 +
                          r2 * (1.0 / 40320 + r2 * (-1.0 / 3628800 +
                                                    r2 * (1.0 / 479001600 + r2 * (-1.0 / 87178291200.0)))))));
  }
  return (quadrant & 2) == 0 ? y : -y;
}

inline double Cos(double x) noexcept { return Sin(x + 1.57079632679489661923); }

/// What has died away is zero: numbers too small to be normal would make every step slow.
inline double WithoutDust(double x) noexcept { return x < 1e-60 && x > -1e-60 ? 0.0 : x; }

/// What a first-order state does over a step, x = step / time constant >= 0.
struct Decay {
  double remaining = 1.0;  ///< e^-x
  double mean = 1.0;       ///< (1 - e^-x) / x, tending to 1
};
inline Decay DecayOver(double x) noexcept {
  const double e = Exp(-x);
  if (x < 1e-3) return {e, 1.0 - x * (0.5 - x * (1.0 / 6 - x * (1.0 / 24)))};
  return {e, (1.0 - e) / x};
}

}  // namespace contour::portable
