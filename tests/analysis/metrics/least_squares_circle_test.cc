#include "analysis/metrics/least_squares_circle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace contour {
namespace {

using Points = std::vector<std::array<double, 2>>;

Points Arc(double cx, double cy, double radius, double sweep_rad, int count) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double angle = sweep_rad * i / count;
    points.push_back({cx + radius * std::cos(angle), cy + radius * std::sin(angle)});
  }
  return points;
}

TEST(LeastSquaresCircle, FindsTheCircleOfPointsOnAnArc) {
  for (const double sweep : {0.5, 2.0, 6.28}) {
    const Points points = Arc(3.0, -7.0, 0.25, sweep, 1000);
    const Circle circle = LeastSquaresCircle(points);
    EXPECT_NEAR(circle.centre[0], 3.0, 1e-10);
    EXPECT_NEAR(circle.centre[1], -7.0, 1e-10);
    EXPECT_NEAR(circle.radius, 0.25, 1e-10);
    EXPECT_NEAR(RadialRange(points, circle.centre), 0.0, 1e-10);
  }
}

TEST(LeastSquaresCircle, NoCircleNearbyFitsBetter) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.02);
  Points points = Arc(0.1, 0.2, 1.0, 4.0, 500);
  for (auto& p : points) p = {p[0] + noise(random), p[1] + noise(random)};
  const auto cost = [&](double cx, double cy, double r) {
    double sum = 0.0;
    for (const auto& p : points) sum += std::pow(std::hypot(p[0] - cx, p[1] - cy) - r, 2);
    return sum;
  };
  const Circle c = LeastSquaresCircle(points);
  const double best = cost(c.centre[0], c.centre[1], c.radius);
  for (const double d : {-1e-3, 1e-3}) {
    EXPECT_LT(best, cost(c.centre[0] + d, c.centre[1], c.radius));
    EXPECT_LT(best, cost(c.centre[0], c.centre[1] + d, c.radius));
    EXPECT_LT(best, cost(c.centre[0], c.centre[1], c.radius + d));
  }
}

}  // namespace
}  // namespace contour
