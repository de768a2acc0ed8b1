#include "core/reference.h"

#include <gtest/gtest.h>

#include <limits>

namespace contour {
namespace {

TEST(ReferenceRequest, ComesBackToATenthOfAMicrometreOnEveryAxis) {
  for (std::uint8_t axis = 0; axis < 8; ++axis) {
    for (const double position_m : {0.0, 1e-7, -1e-7, 0.0123456, -0.0123456, 12.5, -12.5, 26.8, -26.8}) {
      const auto code = Encode({axis, position_m});
      ASSERT_TRUE(code) << position_m;
      const ReferenceRequest back = DecodeReference(*code);
      EXPECT_EQ(back.axis, axis);
      EXPECT_NEAR(back.position_m, position_m, 0.51e-7);
    }
  }
}

TEST(ReferenceRequest, WhatDoesNotFitIsNothing) {
  EXPECT_FALSE(Encode({0, 27.0}));
  EXPECT_FALSE(Encode({0, -27.0}));
  EXPECT_FALSE(Encode({8, 0.0}));
  EXPECT_FALSE(Encode({0, std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(Encode({0, std::numeric_limits<double>::infinity()}));
}

}  // namespace
}  // namespace contour
