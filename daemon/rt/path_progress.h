#pragma once

#include <cstdint>

namespace contour {

/// What who supplies the points of a path needs to know of where the cycle has got to.
struct PathProgress {
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

  std::uint64_t earliest =
      kNowhere;                   ///< point from which on another law of time may begin; kNowhere: at none
  std::uint64_t end = 0;          ///< one past the newest point that is here
  std::uint32_t law = 0;          ///< law of time of the points that are here
  std::uint32_t refused_law = 0;  ///< the last whose first point came too late; 0 none
};

}  // namespace contour
