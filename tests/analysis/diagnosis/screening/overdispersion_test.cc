#include "analysis/diagnosis/screening/overdispersion.h"

#include <gtest/gtest.h>

#include <random>

namespace contour::diagnosis {
namespace {

constexpr Eigen::Index kCount = 600;

/// Gradients of two amplitudes, blocks of which `together` have one sign.
Eigen::MatrixXd Gradients(Eigen::Index together, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd out(2, kCount);
  for (Eigen::Index i = 0; i < 2; ++i)
    for (Eigen::Index b = 0; b < kCount; ++b) out(i, b) = b % together == 0 ? normal(random) : out(i, b - 1);
  return out;
}

/// Of the amplitudes whose gradients have unit variance in every block.
const Eigen::MatrixXd kCovariance = Eigen::MatrixXd::Identity(2, 2) / static_cast<double>(kCount);

TEST(Overdispersion, OfWhiteNoiseIsOne) {
  EXPECT_NEAR(WithinBlocks(Gradients(1, 1), kCovariance), 1.0, 0.15);
  double mean = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) mean += Overdispersion(Gradients(1, seed), kCovariance) / 10.0;
  EXPECT_NEAR(mean, 1.1, 0.25) << "never below one, so a little above it on the average";
}

TEST(Overdispersion, OfNoiseOfThreeTimesTheSizeIsNine) {
  EXPECT_NEAR(WithinBlocks(3.0 * Gradients(1, 2), kCovariance), 9.0, 1.5);
  EXPECT_GE(Overdispersion(3.0 * Gradients(1, 2), kCovariance),
            WithinBlocks(3.0 * Gradients(1, 2), kCovariance));
}

TEST(Overdispersion, NeighboursThatGoTogetherScatterMore) {
  const Eigen::MatrixXd blocks = Gradients(6, 3);
  EXPECT_NEAR(WithinBlocks(blocks, kCovariance), 1.0, 0.4);
  EXPECT_GT(Overdispersion(blocks, kCovariance), 3.0);
}

TEST(Overdispersion, IsNeverBelowOne) {
  EXPECT_EQ(WithinBlocks(0.1 * Gradients(1, 4), kCovariance), 1.0);
  EXPECT_EQ(Overdispersion(0.1 * Gradients(1, 4), kCovariance), 1.0);
}

}  // namespace
}  // namespace contour::diagnosis
