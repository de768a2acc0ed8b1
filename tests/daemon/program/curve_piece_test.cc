#include "daemon/program/curve_piece.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/daemon/program/on_a_table.h"

namespace contour {
namespace {

using testing::Point;

const double kPi = std::numbers::pi;

std::vector<CurvePiece> Pieces() {
  return {PointPiece(Point(1.0, 2.0)),
          LinePiece(Point(1.0, 2.0), Point(4.0, -2.0)),
          ArcPiece(Point(1.0, 2.0), {0, 1}, {0.0, 2.0}, 1.5 * kPi),
          ArcPiece(Point(1.0, 2.0), {0, 1}, {0.5, 1.5}, -0.3),
          ArcPiece(Point(1.0, 2.0), {1, 0}, {0.0, 0.0}, 5.0 * kPi),
          SinePiece(Point(1.0, 2.0), 1, 0.7, 2)};
}

double Separation(const PerAxis<double>& a, const PerAxis<double>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

TEST(CurvePiece, ShortestDistanceIsThatOfTheNearestOfManyPoints) {
  for (const CurvePiece& piece : Pieces()) {
    for (double x = -3.0; x <= 5.0; x += 0.37) {
      for (double y = -3.0; y <= 5.0; y += 0.41) {
        constexpr int kPoints = 4000;
        double nearest = std::numeric_limits<double>::infinity();
        for (int i = 0; i <= kPoints; ++i) {
          const auto p = PointAt(piece, piece.length_m * i / kPoints).position_m;
          nearest = std::min(nearest, Separation(p, Point(x, y)));
        }
        const double distance = Distance_m(piece, Point(x, y));
        EXPECT_LE(distance, nearest + 1e-12);
        EXPECT_GE(distance, nearest - piece.length_m / kPoints - 1e-12) << x << " " << y;
      }
    }
  }
}

TEST(CurvePiece, DerivativesAreThoseOfThePosition) {
  for (const CurvePiece& piece : Pieces()) {
    constexpr double kStep = 1e-4;
    for (double s = kStep; s < piece.length_m; s += piece.length_m / 37.0) {
      const CurvePoint before = PointAt(piece, s - kStep);
      const CurvePoint at = PointAt(piece, s);
      const CurvePoint after = PointAt(piece, s + kStep);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(at.tangent[i], (after.position_m[i] - before.position_m[i]) / (2 * kStep), 1e-7);
        EXPECT_NEAR(at.curvature_1_m[i], (after.tangent[i] - before.tangent[i]) / (2 * kStep), 1e-7);
      }
    }
  }
}

TEST(CurvePiece, ExtentTouchesThePiece) {
  for (const CurvePiece& piece : Pieces()) {
    Extent sampled{piece.start_m, piece.start_m};
    constexpr int kPoints = 4000;
    for (int k = 0; k <= kPoints; ++k) {
      const auto p = PointAt(piece, piece.length_m * k / kPoints).position_m;
      for (std::size_t i = 0; i < 2; ++i) {
        sampled.min_m[i] = std::min(sampled.min_m[i], p[i]);
        sampled.max_m[i] = std::max(sampled.max_m[i], p[i]);
      }
    }
    const Extent extent = ExtentOf(piece);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(extent.min_m[i], sampled.min_m[i], 1e-4);
      EXPECT_NEAR(extent.max_m[i], sampled.max_m[i], 1e-4);
    }
  }
}

}  // namespace
}  // namespace contour
