#pragma once

#include <cstddef>

#include "core/axis.h"
#include "core/horizon.h"

namespace contour {

/// A point of the path with its derivatives by time, per axis.
struct PathSample {
  PerAxis<double> position_m;
  PerAxis<double> velocity_m_s;
  PerAxis<double> acceleration_m_s2;
};

/// The curve through the reference points of a horizon: cubic Hermite between them, and the parabola of the
/// first or last point's velocity and acceleration beyond the ends. Time is counted in periods from element
/// 0. Views the horizon, which must outlive it and have a point on every axis.
class ContourPath {
 public:
  ContourPath(const PerAxis<AxisHorizon>& reference, double period_s) noexcept;

  [[nodiscard]] std::size_t axes() const noexcept { return reference_->size(); }
  /// Time of the last point.
  [[nodiscard]] double end() const noexcept { return static_cast<double>(points_ - 1); }
  void At(double periods, PathSample& sample) const noexcept;
  /// Square of the distance from the path's point of a whole number of periods.
  [[nodiscard]] double Distance2(const PerAxis<double>& position_m, std::size_t point) const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < position_m.size(); ++i) {
      const double e = position_m[i] - (*reference_)[i][point].position_m;
      sum += e * e;
    }
    return sum;
  }
  /// Unit vector of the direction of motion; false, and all zero, where the path stands still.
  static bool Tangent(const PathSample& sample, PerAxis<double>& tangent) noexcept;
  /// Curvature in 1/m; 0 where the path stands still.
  static double Curvature_1_m(const PathSample& sample) noexcept;

 private:
  const PerAxis<AxisHorizon>* reference_;
  std::size_t points_;
  double period_s_;
};

}  // namespace contour
