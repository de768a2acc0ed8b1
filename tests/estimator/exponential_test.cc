#include "estimator/exponential.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

TEST(Exponential, MatchesTheLibraryOverTheWholeRange) {
  for (int i = -70000; i <= 70000; ++i) {
    const double x = 0.00993 * i;
    const double e = static_cast<double>(std::exp(static_cast<long double>(x)));
    ASSERT_NEAR(Exp(x) / e, 1.0, 1e-15) << x;
  }
}

TEST(Exponential, Expm1KeepsItsDigitsNearZero) {
  for (int decade = -18; decade <= 2; ++decade) {
    for (const double sign : {-1.0, 1.0}) {
      const double x = sign * 1.7 * std::pow(10.0, decade);
      const double e = static_cast<double>(std::expm1(static_cast<long double>(x)));
      ASSERT_NEAR(Expm1(x) / e, 1.0, 2e-15) << x;
    }
  }
  EXPECT_EQ(Expm1(0.0), 0.0);
  EXPECT_EQ(Exp(0.0), 1.0);
}

TEST(Exponential, FourSideBySideAreTheSameAsOneByOne) {
  for (int i = 0; i < 800; ++i) {
    const double x = -0.97 * i;
    wide::Quad four{x, -1e-9 * i, -701.0, std::nan("")}, e, expm1;
    ExpOfNegative<wide::Quad>(four, e);
    Expm1OfNegative<wide::Quad>(four, expm1);
    for (int j = 0; j < 3; ++j) {
      EXPECT_EQ(e[j], ExpOfNegative(four[j])) << four[j];
      EXPECT_EQ(expm1[j], Expm1OfNegative(four[j])) << four[j];
    }
    EXPECT_TRUE(std::isnan(e[3]) && std::isnan(expm1[3]));
  }
}

TEST(Exponential, SaturatesInsteadOfOverflowing) {
  EXPECT_TRUE(std::isfinite(Exp(1e300)));
  EXPECT_GE(Exp(-1e300), 0.0);
  EXPECT_LT(Exp(-1e300), 1e-300);
  EXPECT_EQ(Expm1(-1e300), -1.0);
}

TEST(Exponential, PassesNaNOn) {
  EXPECT_TRUE(std::isnan(Exp(std::nan(""))));
  EXPECT_TRUE(std::isnan(Expm1(std::nan(""))));
}

}  // namespace
}  // namespace contour
