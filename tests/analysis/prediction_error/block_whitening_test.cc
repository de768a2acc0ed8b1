#include "analysis/prediction_error/block_whitening.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace contour::diagnosis {
namespace {

TEST(BlockWhitening, TakesOutLevelAndCorrelation) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::VectorXd errors(40000);
  double last = 0.0;
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    last = 0.9 * last + normal(random);
    errors(i) = last * (i < 20000 ? 1e-9 : 5e-9);
  }
  BlockWhitening whitening;
  whitening.Learn(errors, 1000, 6, 1e-12);
  const Eigen::VectorXd white = whitening.Apply(errors);
  const double power = white.squaredNorm() / static_cast<double>(white.size());
  EXPECT_NEAR(power, 1.0, 0.05);
  const double next = white.head(39999).dot(white.tail(39999)) / white.squaredNorm();
  EXPECT_LT(std::fabs(next), 0.03);
  const double ratio = white.head(20000).squaredNorm() / white.tail(20000).squaredNorm();
  EXPECT_NEAR(ratio, 1.0, 0.1);
}

}  // namespace
}  // namespace contour::diagnosis
