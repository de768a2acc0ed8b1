#pragma once

#include <cstring>

// Neighbouring numbers in one register, in a notation that GCC and Clang know on all targets.
namespace contour::wide {

/// Two: the baseline has registers of 16 bytes.
using Pair = double __attribute__((vector_size(16)));

inline Pair Load(const double* p) noexcept {
  Pair v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void Store(double* p, Pair v) noexcept { std::memcpy(p, &v, sizeof v); }

/// Four: two registers of the baseline, one where there is AVX2. Only ever a local variable, or a reference
/// to one, of something inlined, since how it would be passed depends on the processor.
using Quad = double __attribute__((vector_size(32)));

/// Four in memory, wherever they begin. (memcpy becomes two halves where the baseline inlines it, and a
/// register cannot be loaded at once from two that were just stored.)
using QuadInMemory = double __attribute__((vector_size(32), aligned(8), may_alias));

[[gnu::always_inline]] inline void Load(const double* p, Quad& v) noexcept {
  v = *reinterpret_cast<const QuadInMemory*>(p);
}
[[gnu::always_inline]] inline void Store(double* p, const Quad& v) noexcept {
  *reinterpret_cast<QuadInMemory*>(p) = v;
}

using QuadBits = long long __attribute__((vector_size(32)));

/// Without their signs.
[[gnu::always_inline]] inline void Sizes(const Quad& x, Quad& out) noexcept {
  constexpr long long kAllButSign = 0x7fffffffffffffff;
  const QuadBits mask{kAllButSign, kAllButSign, kAllButSign, kAllButSign};
  out = reinterpret_cast<Quad>(reinterpret_cast<QuadBits>(x) & mask);
}

/// Positive numbers with the signs of `like`.
[[gnu::always_inline]] inline void WithSigns(const Quad& positive, const Quad& like, Quad& out) noexcept {
  Quad size;
  Sizes(like, size);
  const QuadBits signs = reinterpret_cast<QuadBits>(like) ^ reinterpret_cast<QuadBits>(size);
  out = reinterpret_cast<Quad>(reinterpret_cast<QuadBits>(positive) | signs);
}

/// Each between -most and most.
[[gnu::always_inline]] inline void Clamp(Quad& x, double most) noexcept {
  const Quad high = Quad{} + most, low = -high;
  x = x < low ? low : x;
  x = high < x ? high : x;
}

}  // namespace contour::wide
