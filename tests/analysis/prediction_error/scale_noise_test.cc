#include "analysis/prediction_error/scale_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace contour::diagnosis {
namespace {

constexpr std::size_t kRows = 4000;

/// Strokes of 40 mm to either side of the middle.
Signals Strokes() {
  Signals s;
  s.half_stroke_m = 0.04;
  for (std::size_t k = 0; k < kRows; ++k)
    s.table_m.push_back(0.04 * std::sin(0.011 * static_cast<double>(k)));
  return s;
}

double Rms(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v * v;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

TEST(ScaleNoise, ASmoothErrorOfTheLeadGoesAndTheNoiseStays) {
  const Signals s = Strokes();
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1e-8);
  std::vector<double> residual(kRows), only(kRows);
  for (std::size_t k = 0; k < kRows; ++k) {
    const double u = s.table_m[k] / s.half_stroke_m;
    only[k] = noise(random);
    residual[k] = only[k] + 3e-6 + 2e-6 * std::cos(std::numbers::pi * (u + 1.0)) +
                  1e-6 * std::cos(1.5 * std::numbers::pi * (u + 1.0));
  }
  const std::vector<double> left = WithoutShape(residual, std::vector<std::uint8_t>(kRows, 1), s);
  EXPECT_GT(Rms(residual), 1e-6);
  EXPECT_NEAR(Rms(left) / Rms(only), 1.0, 0.1);
}

TEST(ScaleNoise, RowsThatDoNotCountAreNeitherLearntFromNorChanged) {
  const Signals s = Strokes();
  std::vector<double> residual(kRows, 1e-6);
  std::vector<std::uint8_t> counted(kRows, 1);
  residual[100] = 1.0;
  counted[100] = 0;
  const std::vector<double> left = WithoutShape(residual, counted, s);
  EXPECT_EQ(left[100], 1.0);
  EXPECT_LT(std::fabs(left[200]), 1e-10);
}

TEST(ScaleNoise, AnAxisThatHardlyMovesHasNoShape) {
  Signals s = Strokes();
  for (double& x : s.table_m) x = 0.0;
  s.half_stroke_m = 0.0;
  std::vector<double> residual(kRows);
  for (std::size_t k = 0; k < kRows; ++k) residual[k] = std::sin(static_cast<double>(k * k));
  for (const double x : WithoutShape(residual, std::vector<std::uint8_t>(kRows, 1), s))
    ASSERT_TRUE(std::isfinite(x));
}

TEST(ScaleNoise, ACountIsTheSmallestDifference) {
  const std::vector<double> moves = {0.0, 3e-7, 3e-7, 2e-7, 6e-7};
  EXPECT_NEAR(CountOf(moves), 1e-7, 1e-12);
  EXPECT_TRUE(std::isinf(CountOf(std::vector<double>(5, 0.2))));
}

}  // namespace
}  // namespace contour::diagnosis
