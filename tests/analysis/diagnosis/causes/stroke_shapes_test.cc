#include "analysis/diagnosis/causes/stroke_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

using std::numbers::pi;

/// Mean of a product over the stroke, by the midpoints of many pieces.
double Mean(StrokeBasis basis, unsigned i, unsigned j) {
  constexpr int kPieces = 4000;
  double sum = 0.0;
  for (int n = 0; n < kPieces; ++n) {
    const double u = -1.0 + (n + 0.5) * 2.0 / kPieces;
    sum += basis(i, u) * basis(j, u);
  }
  return sum / kPieces;
}

TEST(StrokeShapes, CosinesHaveHalfPeriodsFromEndToEnd) {
  EXPECT_NEAR(CosineAt(1, -1.0), 1.0, 1e-12);
  EXPECT_NEAR(CosineAt(1, 0.0), 0.0, 1e-12);
  EXPECT_NEAR(CosineAt(1, 1.0), -1.0, 1e-12);
  EXPECT_NEAR(CosineAt(2, 0.0), -1.0, 1e-12);
  EXPECT_NEAR(CosineAt(2, 1.0), 1.0, 1e-12);
}

TEST(StrokeShapes, LegendrePolynomialsAreThoseOfTheTables) {
  for (const double u : {-1.0, -0.3, 0.0, 0.8, 1.0}) {
    EXPECT_NEAR(LegendreAt(1, u), u, 1e-12);
    EXPECT_NEAR(LegendreAt(2, u), 0.5 * (3.0 * u * u - 1.0), 1e-12);
    EXPECT_NEAR(LegendreAt(3, u), 0.5 * (5.0 * u * u * u - 3.0 * u), 1e-12);
  }
}

TEST(StrokeShapes, NeitherBasisDoesTwiceTheSame) {
  for (unsigned i = 1; i <= 4; ++i)
    for (unsigned j = 1; j <= 4; ++j) {
      EXPECT_NEAR(Mean(CosineAt, i, j), i == j ? 0.5 : 0.0, 1e-6);
      EXPECT_NEAR(Mean(LegendreAt, i, j), i == j ? 1.0 / (2.0 * i + 1.0) : 0.0, 1e-6);
    }
}

TEST(StrokeShapes, SignalsAreTheBasisAtTheTablesPlace) {
  const test::KnownAxis axis;
  const std::vector<SharedSignal> cosines = Cosines(axis.signals(), 2, 4),
                                  legendre = LegendrePolynomials(axis.signals(), 3);
  ASSERT_EQ(cosines.size(), 3u);
  ASSERT_EQ(legendre.size(), 3u);
  for (const std::size_t row : {0u, 321u, 1234u}) {
    const double u = axis.signals().table_m[row] / 0.05;
    EXPECT_NEAR((*cosines[0])[row], std::cos(pi * (u + 1.0)), 1e-12);
    EXPECT_NEAR((*cosines[2])[row], std::cos(2.0 * pi * (u + 1.0)), 1e-12);
    EXPECT_NEAR((*legendre[0])[row], u, 1e-12);
  }
}

TEST(StrokeShapes, BeyondTheStrokeTheyStayAsTheyEnd) {
  const test::KnownAxis axis;
  const Signal y = OverStroke(axis.signals(), {2.0, 1.0}, CosineAt, {-0.2, -0.05, 0.05, 0.2});
  EXPECT_NEAR(y[0], 3.0, 1e-12);
  EXPECT_EQ(y[0], y[1]);
  EXPECT_NEAR(y[2], -1.0, 1e-12);
  EXPECT_EQ(y[2], y[3]);
}

TEST(StrokeShapes, TheGridGoesFromEndToEnd) {
  const test::KnownAxis axis;
  const std::vector<double> x = StrokeGrid(axis.signals());
  EXPECT_NEAR(x.front(), -0.05, 1e-12);
  EXPECT_NEAR(x.back(), 0.05, 1e-12);
  for (std::size_t i = 1; i < x.size(); ++i)
    EXPECT_NEAR(x[i] - x[i - 1], 0.1 / static_cast<double>(x.size() - 1), 1e-12);
}

TEST(StrokeShapes, HalfTheRangeIsOfTheSumAndNotOfItsParts) {
  const test::KnownAxis axis;
  Point point;
  point.effects = {test::OnGrid(axis, "position_friction", "")};
  point.amplitudes = {{0.0, 0.3}};
  EXPECT_NEAR(HalfRange(FittedEffect{axis.problem, point, 0}), 0.3, 1e-9);
  // 0.3 cos 2x - 0.3 cos x over 0 to pi: highest 0.6 at the end, lowest -0.3 (1 + 1 / 8) at cos x = 1 / 4.
  point.amplitudes = {{-0.3, 0.3}};
  EXPECT_NEAR(HalfRange(FittedEffect{axis.problem, point, 0}), 0.5 * (0.6 + 0.3 * 1.125), 1e-3);
}

TEST(StrokeShapes, AnAxisThatDidNotMoveHasNoPlaces) {
  test::KnownAxis axis;
  axis.problem.signals->half_stroke_m = 0.0;
  axis.problem.signals->table_m.assign(test::KnownAxis::kRows, 0.0);
  for (const double v : *Cosines(axis.signals(), 1, 1)[0]) ASSERT_TRUE(std::isfinite(v));
}

}  // namespace
}  // namespace contour::diagnosis
