#include "analysis/metrics/least_squares_circle.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace contour {
namespace {

constexpr int kMaxSteps = 50;
constexpr double kConverged = 1e-15;  // of the radius

Circle FirstGuess(std::span<const std::array<double, 2>> points) {
  Circle guess;
  const auto n = static_cast<double>(points.size());
  for (const auto& p : points) {
    guess.centre[0] += p[0] / n;
    guess.centre[1] += p[1] / n;
  }
  for (const auto& p : points) {
    guess.radius += std::hypot(p[0] - guess.centre[0], p[1] - guess.centre[1]) / n;
  }
  return guess;
}

}  // namespace

Circle LeastSquaresCircle(std::span<const std::array<double, 2>> points) {
  Circle circle = FirstGuess(points);
  for (int step = 0; step < kMaxSteps; ++step) {
    // Residual d - r with d = |p - c|; its gradient by (cx, cy, r) is (-(p - c) / d, -1).
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const auto& p : points) {
      const double dx = p[0] - circle.centre[0];
      const double dy = p[1] - circle.centre[1];
      const double d = std::hypot(dx, dy);
      if (d == 0.0) continue;
      const Eigen::Vector3d gradient(-dx / d, -dy / d, -1.0);
      normal += gradient * gradient.transpose();
      right -= gradient * (d - circle.radius);
    }
    const Eigen::Vector3d change = normal.ldlt().solve(right);
    circle.centre[0] += change[0];
    circle.centre[1] += change[1];
    circle.radius += change[2];
    if (change.norm() <= kConverged * circle.radius) break;
  }
  return circle;
}

double RadialRange(std::span<const std::array<double, 2>> points, const std::array<double, 2>& centre) {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (const auto& p : points) {
    const double r = std::hypot(p[0] - centre[0], p[1] - centre[1]);
    smallest = std::min(smallest, r);
    largest = std::max(largest, r);
  }
  return largest - smallest;
}

}  // namespace contour
