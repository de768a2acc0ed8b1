#include "estimator/turn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace contour {
namespace {

TEST(Turn, MatchesTheLibrary) {
  for (int i = -4000; i <= 4000; ++i) {
    const double turns = 0.000731 * i;
    const CosSin c = Turn(turns);
    const long double angle = 2.0L * std::numbers::pi_v<long double> * static_cast<long double>(turns);
    ASSERT_NEAR(c.cos, static_cast<double>(std::cos(angle)), 2e-15) << turns;
    ASSERT_NEAR(c.sin, static_cast<double>(std::sin(angle)), 2e-15) << turns;
  }
}

TEST(Turn, WholeTurnsChangeNothing) {
  for (const double turns : {0.125, 0.25, 0.375, 0.5, 0.6875, 0.75, 0.9375}) {
    for (const double whole : {1.0, -1.0, 1048576.0, -1048576.0}) {
      EXPECT_EQ(Turn(turns).cos, Turn(turns + whole).cos) << turns << " " << whole;
      EXPECT_EQ(Turn(turns).sin, Turn(turns + whole).sin) << turns << " " << whole;
    }
  }
}

}  // namespace
}  // namespace contour
