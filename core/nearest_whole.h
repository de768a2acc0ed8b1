#pragma once

#include <cmath>
#include <cstdint>

namespace contour {

/// llround of what 64 bits hold, as plain arithmetic: halves go away from zero. What is added is the number
/// next below a half, or what is next below a half itself would go up.
[[nodiscard]] inline std::int64_t NearestWhole(double x) noexcept {
  constexpr double kBelowHalf = 0.49999999999999994;
  return static_cast<std::int64_t>(x + std::copysign(kBelowHalf, x));
}

}  // namespace contour
