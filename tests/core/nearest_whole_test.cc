#include "core/nearest_whole.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace contour {
namespace {

TEST(NearestWhole, IsWhatTheLibraryRoundsTo) {
  constexpr double kHalf = 0.5;
  const std::array<double, 16> numbers{0.0,
                                       kHalf,
                                       std::nextafter(kHalf, 0.0),
                                       std::nextafter(kHalf, 1.0),
                                       1.5,
                                       std::nextafter(1.5, 0.0),
                                       2.5,
                                       std::nextafter(2.5, 0.0),
                                       1048575.5,
                                       2147483647.5,
                                       4503599627370495.5,  // the last half there is
                                       4503599627370497.0,
                                       9007199254740991.0,
                                       8999999999999999.0,
                                       1e-300,
                                       std::numeric_limits<double>::denorm_min()};
  for (const double x : numbers) {
    EXPECT_EQ(NearestWhole(x), std::llround(x)) << x;
    EXPECT_EQ(NearestWhole(-x), std::llround(-x)) << -x;
  }
  for (int k = -4000; k < 4000; ++k) EXPECT_EQ(NearestWhole(0.125 * k), std::llround(0.125 * k)) << k;
}

}  // namespace
}  // namespace contour
