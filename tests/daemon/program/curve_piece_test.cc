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

PerAxis<double> InSpace(double x, double y, double z) {
  PerAxis<double> p(3);
  p[0] = x;
  p[1] = y;
  p[2] = z;
  return p;
}

/// Helices of every plane, steep and flat, of less than a turn and of several.
std::vector<CurvePiece> Helices() {
  std::vector<CurvePiece> helices;
  for (const std::array<std::size_t, 2> plane : {std::array<std::size_t, 2>{0, 1}, {2, 0}, {1, 2}}) {
    const PerAxis<double> from = InSpace(1.0, 2.0, -1.0);
    const std::size_t normal = 3 - plane[0] - plane[1];
    for (const double rise : {0.02, -0.7, 9.0}) {
      for (const double sweep : {0.8, -2.5 * kPi, 6.0 * kPi}) {
        PerAxis<double> to = from;
        to[normal] += rise;
        helices.push_back(HelixPiece(from, to, plane, {from[plane[0]] - 0.6, from[plane[1]] + 0.8}, sweep));
      }
    }
  }
  return helices;
}

TEST(CurvePiece, HelicesRunByArcLengthToTheirEnd) {
  for (const CurvePiece& helix : Helices()) {
    constexpr double kStep = 1e-4;
    for (double s = kStep; s < helix.length_m; s += helix.length_m / 37.0) {
      const CurvePoint before = PointAt(helix, s - kStep), at = PointAt(helix, s),
                       after = PointAt(helix, s + kStep);
      double squared = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(at.tangent[i], (after.position_m[i] - before.position_m[i]) / (2 * kStep), 1e-7);
        EXPECT_NEAR(at.curvature_1_m[i], (after.tangent[i] - before.tangent[i]) / (2 * kStep), 1e-7);
        squared += at.tangent[i] * at.tangent[i];
      }
      EXPECT_NEAR(squared, 1.0, 1e-12);
    }
  }
  const CurvePiece flat = HelixPiece(InSpace(1, 0, 3), InSpace(1, 0, 3), {0, 1}, {0.0, 0.0}, kPi);
  EXPECT_EQ(flat.round_share, 1.0);
  const CurvePiece climbing = HelixPiece(InSpace(1, 0, 3), InSpace(-1, 0, 5), {0, 1}, {0.0, 0.0}, kPi);
  EXPECT_NEAR(PointAt(climbing, climbing.length_m).position_m[0], -1.0, 1e-12);
  EXPECT_NEAR(PointAt(climbing, climbing.length_m).position_m[2], 5.0, 1e-12);
}

TEST(CurvePiece, DistanceFromAHelixIsThatOfTheNearestOfManyPoints) {
  for (const CurvePiece& helix : Helices()) {
    constexpr int kPoints = 8000;
    const Extent extent = ExtentOf(helix);
    for (int k = 0; k < 60; ++k) {
      const auto share = [&](double factor) { return std::fmod(k * factor, 1.0) * 1.4 - 0.2; };
      PerAxis<double> point(3);
      const double shares[] = {share(0.618034), share(0.754878), share(0.569840)};
      for (std::size_t i = 0; i < 3; ++i)
        point[i] = extent.min_m[i] + shares[i] * (extent.max_m[i] - extent.min_m[i] + 0.1);
      double nearest = std::numeric_limits<double>::infinity();
      for (int i = 0; i <= kPoints; ++i) {
        const auto p = PointAt(helix, helix.length_m * i / kPoints).position_m;
        nearest = std::min(nearest, std::hypot(p[0] - point[0], p[1] - point[1], p[2] - point[2]));
      }
      const double distance = Distance_m(helix, point);
      EXPECT_LE(distance, nearest + 1e-12);
      EXPECT_GE(distance, nearest - helix.length_m / kPoints - 1e-12);
    }
  }
}

TEST(CurvePiece, PartsOfAHelixAreTheHelix) {
  PerAxis<double> from_m(3), to_m(3);
  from_m[0] = 0.003;
  from_m[1] = -0.001;
  from_m[2] = 0.002;
  to_m = from_m;
  to_m[2] = -0.1;
  const CurvePiece whole = HelixPiece(from_m, to_m, {0, 1}, {0.001, 0.001}, -1234.5);
  for (const double from : {0.0, 0.001, 0.3 * whole.length_m, 0.99 * whole.length_m}) {
    const double to = std::min(whole.length_m, from + 0.004);
    const CurvePiece part = PartOfArc(whole, from, to);
    EXPECT_DOUBLE_EQ(part.length_m, to - from);
    for (const double share : {0.0, 0.3, 1.0}) {
      const CurvePoint a = PointAt(part, share * part.length_m);
      const CurvePoint b = PointAt(whole, from + share * part.length_m);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(a.position_m[i], b.position_m[i], 1e-14);
        EXPECT_NEAR(a.tangent[i], b.tangent[i], 1e-11);
        EXPECT_NEAR(a.curvature_1_m[i], b.curvature_1_m[i], 1e-8);
      }
    }
  }
}

}  // namespace
}  // namespace contour
