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

}  // namespace contour::wide
