#pragma once

#include <bit>
#include <cstdint>

// Eight runs of the same model side by side: the runs differ in parameters only, so one instruction stream
// serves all of them and their latencies hide each other. Each lane's result is the same whatever runs beside
// it.
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
  const Vec r2 = r * r;
  const Vec a = 1.0 + r;
  const Vec b = 0.5 + r * (1.0 / 6);
  const Vec c = 1.0 / 24 + r * (1.0 / 120);
  const Vec d = 1.0 / 720 + r * (1.0 / 5040);
  const Vec p = a + r2 * (b + r2 * (c + r2 * (d + r2 * (1.0 / 40320))));
  return std::bit_cast<Vec>((std::bit_cast<VecBits>(shifted) << 52) + std::bit_cast<VecBits>(p));
}

/// What a first-order state keeps over a step of x time constants, and the mean of its decay.
struct LaneDecay {
  Vec remaining, mean;
};
CONTOUR_LANES_INLINE LaneDecay DecayOver(const Vec& x) {
  const Vec e = ExpNegative(-x);
  const Vec safe = x > 1e-3 ? x : Spread(1e-3);
  return {e, x > 1e-3 ? (1.0 - e) / safe : 1.0 - x * (0.5 - x * (1.0 / 6))};
}

}  // namespace contour::diagnosis
