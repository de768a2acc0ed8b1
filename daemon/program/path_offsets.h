#pragma once

#include <cmath>
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

  /// The same between grid points, where a program is that does not keep its own pace.
  void AddBetween(double time, PathPoint& point) const {
    const double whole = std::floor(time);
    const auto index = static_cast<std::size_t>(whole);
    const double s = time - whole;
    if (s == 0.0) return AddTo(index, point);
    for (std::size_t i = 0; i < point.axes.size() && i < offset_m.size(); ++i) {
      const double p0 = index == 0 ? 0.0 : At(i, index - 1);
      const double p1 = At(i, index), p2 = At(i, index + 1), p3 = At(i, index + 2);
      // Catmull-Rom.
      const double c1 = 0.5 * (p2 - p0), c2 = p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3;
      const double c3 = 0.5 * (p3 - p0) + 1.5 * (p1 - p2);
      point.axes[i].position_m += p1 + s * (c1 + s * (c2 + s * c3));
      point.axes[i].velocity_m_s += (c1 + s * (2.0 * c2 + s * 3.0 * c3)) / period_s;
      point.axes[i].acceleration_m_s2 += (2.0 * c2 + 6.0 * s * c3) / (period_s * period_s);
    }
  }
};

}  // namespace contour
