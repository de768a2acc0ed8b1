#pragma once

#include <array>
#include <span>

namespace contour {

struct Circle {
  std::array<double, 2> centre{};
  double radius = 0.0;
};

/// The circle with the least sum of squared radial distances to the points (the least-squares circle of ISO
/// 230-4), by Gauss-Newton from their centroid. At least three points that do not lie on a line.
Circle LeastSquaresCircle(std::span<const std::array<double, 2>> points);

/// Largest minus smallest distance of the points from a centre.
double RadialRange(std::span<const std::array<double, 2>> points, const std::array<double, 2>& centre);

}  // namespace contour
