#include "analysis/prediction_error/levinson.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour::diagnosis {
namespace {

// x_k = 0.9 x_k-1 + noise of variance 1: autocovariance 0.9^lag / (1 - 0.81).
TEST(Levinson, FindsTheOneTapOfAFirstOrderProcess) {
  std::vector<double> c;
  for (int lag = 0; lag <= 5; ++lag) c.push_back(std::pow(0.9, lag) / 0.19);
  const ErrorFilter filter = MakeErrorFilter(c);
  ASSERT_EQ(filter.taps.size(), 6U);
  EXPECT_DOUBLE_EQ(filter.taps[0], 1.0);
  EXPECT_NEAR(filter.taps[1], -0.9, 1e-7);
  for (std::size_t i = 2; i < 6; ++i) EXPECT_NEAR(filter.taps[i], 0.0, 1e-7) << i;
  EXPECT_NEAR(filter.left, 1.0, 1e-7);
}

// The normal equations of Yule and Walker hold: the filter's output has nothing in common with the past.
TEST(Levinson, WhatIsLeftIsOrthogonalToThePast) {
  const std::vector<double> c = {2.0, 1.3, 0.2, -0.4, -0.3};
  const ErrorFilter filter = MakeErrorFilter(c);
  for (std::size_t lag = 0; lag < c.size(); ++lag) {
    double sum = 0.0;
    for (std::size_t i = 0; i < c.size(); ++i) sum += filter.taps[i] * c[i > lag ? i - lag : lag - i];
    EXPECT_NEAR(sum, lag == 0 ? filter.left : 0.0, 1e-7) << lag;
  }
  EXPECT_GT(filter.left, 0.0);
  EXPECT_LT(filter.left, c[0]);
}

TEST(Levinson, WhiteNoiseIsLeftAlone) {
  const ErrorFilter filter = MakeErrorFilter(std::vector<double>{3.0, 0.0, 0.0});
  EXPECT_EQ(filter.taps, (std::vector<double>{1.0, 0.0, 0.0}));
  EXPECT_NEAR(filter.left, 3.0, 1e-8);
}

}  // namespace
}  // namespace contour::diagnosis
