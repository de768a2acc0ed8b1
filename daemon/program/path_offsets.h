#pragma once

#include <cstddef>
#include <vector>

#include "core/cycle_input.h"

namespace contour {

/// By how much each grid point of a program is shifted, axis by axis; zero beyond the end. The points go to
/// the cycle shifted: it and its log know the path that is followed and nothing else.
struct PathOffsets {
  double period_s = 0.0;
  std::vector<std::vector<float>> offset_m;  ///< [axis][grid point]

  [[nodiscard]] double At(std::size_t axis, std::size_t index) const {
    return index < offset_m[axis].size() ? static_cast<double>(offset_m[axis][index]) : 0.0;
  }

  /// Position, velocity and acceleration, by central differences.
  void AddTo(std::size_t index, PathPoint& point) const {
    for (std::size_t i = 0; i < point.axes.size() && i < offset_m.size(); ++i) {
      const double before = index == 0 ? 0.0 : At(i, index - 1);
      const double here = At(i, index), after = At(i, index + 1);
      point.axes[i].position_m += here;
      point.axes[i].velocity_m_s += (after - before) / (2.0 * period_s);
      point.axes[i].acceleration_m_s2 += (after - 2.0 * here + before) / (period_s * period_s);
    }
  }
};

}  // namespace contour
