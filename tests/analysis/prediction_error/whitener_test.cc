#include "analysis/prediction_error/whitener.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace contour::diagnosis {
namespace {

/// Filtered by taps, the newest value first.
std::vector<double> Filtered(const std::vector<double>& taps, const std::vector<double>& x) {
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t k = 0; k < x.size(); ++k)
    for (std::size_t i = 0; i < std::min(taps.size(), k + 1); ++i) y[k] += taps[i] * x[k - i];
  return y;
}

double MeanSquare(const std::vector<double>& x, std::size_t lag = 0) {
  double sum = 0.0;
  for (std::size_t k = 100; k + lag < x.size(); ++k) sum += x[k] * x[k + lag];
  return sum / static_cast<double>(x.size() - lag - 100);
}

std::vector<double> Coloured(double pole, double scale, std::size_t rows) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<double> x(rows);
  double last = 0.0;
  for (double& v : x) v = scale * (last = pole * last + normal(random));
  return x;
}

TEST(Whitener, WithoutNoiseToLearnFromLeavesAllAsItIs) {
  EXPECT_EQ(Whitener().taps(), std::vector<double>{1.0});
  const std::vector<double> x(1000, 1.0);
  EXPECT_EQ(Whitener(x, std::vector<std::uint8_t>(1000, 0)).taps(), std::vector<double>{1.0});
}

TEST(Whitener, MakesColouredNoiseWhiteWithUnitVariance) {
  const std::vector<double> x = Coloured(0.8, 1e-6, 60000);
  const Whitener whitener(x, std::vector<std::uint8_t>(x.size(), 1));
  const std::vector<double> white = Filtered(whitener.taps(), x);
  EXPECT_NEAR(MeanSquare(white), 1.0, 0.1);
  for (const std::size_t lag : {1U, 2U, 5U, 20U}) EXPECT_LT(std::fabs(MeanSquare(white, lag)), 0.05) << lag;
  // The filter of a first-order process is known: 1, -pole, 0, ...
  EXPECT_NEAR(whitener.taps()[1] / whitener.taps()[0], -0.8, 0.05);
}

TEST(Whitener, ABurstDoesNotCount) {
  std::vector<double> x = Coloured(0.0, 1.0, 60000);
  for (std::size_t k = 30000; k < 31000; ++k) x[k] *= 100.0;
  const Whitener whitener(x, std::vector<std::uint8_t>(x.size(), 1));
  EXPECT_NEAR(whitener.taps()[0], 1.0, 0.1);
}

TEST(Whitener, ALineIsNoNoise) {
  std::vector<double> x = Coloured(0.0, 1.0, 60000);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] += 3.0 * std::sin(0.7 * static_cast<double>(k));
  const Whitener whitener(x, std::vector<std::uint8_t>(x.size(), 1));
  // The line would be four and a half times the noise.
  EXPECT_NEAR(whitener.taps()[0], 1.0, 0.15);
}

}  // namespace
}  // namespace contour::diagnosis
