#include "analysis/identification/basins.h"

#include <algorithm>

namespace contour::identify {

std::vector<std::size_t> Basins(std::span<const double> errors) {
  std::vector<std::size_t> basins;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const bool from_before = i == 0 || errors[i] < errors[i - 1];
    // A flat stretch is one place, its first.
    std::size_t after = i + 1;
    while (after < errors.size() && errors[after] == errors[i]) ++after;
    const bool from_after = after == errors.size() || errors[i] < errors[after];
    if (from_before && from_after) basins.push_back(i);
  }
  std::sort(basins.begin(), basins.end(),
            [&](std::size_t a, std::size_t b) { return errors[a] < errors[b]; });
  return basins;
}

}  // namespace contour::identify
