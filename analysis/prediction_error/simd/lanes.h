#pragma once

#include <bit>
#include <cstdint>

// Eight runs of the same model side by side: the runs differ in parameters only, so one instruction stream
// serves all of them and their latencies hide each other. Each lane's result is the same whatever runs next
// to it.
namespace contour::diagnosis {

inline constexpr int kLanes = 8;

using Vec [[gnu::vector_size(64)]] = double;
using VecBits [[gnu::vector_size(64)]] = std::int64_t;

#define CONTOUR_LANES_INLINE [[gnu::always_inline]] inline

CONTOUR_LANES_INLINE Vec Spread(double x) { return Vec{x, x, x, x, x, x, x, x}; }

CONTOUR_LANES_INLINE Vec Abs(const Vec& x) { return x < 0.0 ? -x : x; }

/// e^x for x <= 0, relative error under 1e-9 and smooth, which is what differences of runs need.
CONTOUR_LANES_INLINE Vec ExpNegative(const Vec& x) {
  constexpr double kMagic = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
  const Vec y = x < -700.0 ? Spread(-700.0) : x;
  const Vec shifted = y * 1.44269504088896338700 + kMagic;
  const Vec k = shifted - kMagic;
  const Vec r = y - k * 0.693147180559945309417;
  // Pairs of terms first (Estrin), so that little of it waits for the rest.
  const Vec r2 = r * r;
  const Vec r4 = r2 * r2;
  const Vec a = 1.0 + r;
  const Vec b = 0.5 + r * (1.0 / 6);
  const Vec c = 1.0 / 24 + r * (1.0 / 120);
  const Vec d = 1.0 / 720 + r * (1.0 / 5040);
  const Vec p = (a + r2 * b) + r4 * ((c + r2 * d) + r4 * (1.0 / 40320));
  return std::bit_cast<Vec>((std::bit_cast<VecBits>(shifted) << 52) + std::bit_cast<VecBits>(p));
}

}  // namespace contour::diagnosis
