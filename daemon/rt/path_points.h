#pragma once

#include <array>
#include <cstdint>

#include "core/axis.h"
#include "core/path_room.h"

namespace contour {

/// Time on the path and its first two derivatives, in periods.
struct PathPace {
  double time = 0.0;
  double rate = 0.0;
  double rate_change = 0.0;
};

/// One ring for each axis: every cycle takes some tens of points that follow one another.
using PathRings = std::array<std::array<ReferencePoint, kPathCapacity>, kMaxAxes>;

/// Value and derivatives by s of an interpolation.
struct Interpolated {
  double value, first, second, third;
};

/// Quintic Hermite interpolation on [0, 1] through position, velocity and acceleration (per period) at both
/// ends.
inline Interpolated Quintic(double p0, double v0, double a0, double p1, double v1, double a1,
                            double s) noexcept {
  const double d = p1 - p0;
  const double c3 = 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
  const double c4 = -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
  const double c5 = 6 * d - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
  return {p0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5)))),
          v0 + s * (a0 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5))),
          a0 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5)), 6 * c3 + s * (24 * c4 + s * 60 * c5)};
}

/// The points of a path that are here, seen as a curve. Indices and times count periods from its beginning.
struct PathPoints {
  const PathRings* rings = nullptr;
  std::size_t axes = 0;
  std::uint64_t first = 0;  ///< oldest
  std::uint64_t end = 0;    ///< one past the newest
  bool whole = false;       ///< the newest is the path's last, at rest
  double period_s = 0.0;

  [[nodiscard]] const ReferencePoint& At(std::size_t axis, std::uint64_t index) const noexcept {
    return (*rings)[axis][index % kPathCapacity];
  }
  /// Between a point and the next one.
  [[nodiscard]] Interpolated Between(std::size_t axis, std::uint64_t index, double s) const noexcept {
    const ReferencePoint& a = At(axis, index);
    const ReferencePoint& b = At(axis, index + 1);
    const double h = period_s;
    return Quintic(a.position_m, a.velocity_m_s * h, a.acceleration_m_s2 * h * h, b.position_m,
                   b.velocity_m_s * h, b.acceleration_m_s2 * h * h, s);
  }
};

}  // namespace contour
