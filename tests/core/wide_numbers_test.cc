#include "core/wide_numbers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace contour {
namespace {

using Four = std::array<double, 4>;

Four Of(const wide::Quad& q) {
  Four out;
  wide::Store(out.data(), q);
  return out;
}

TEST(WideNumbers, HaveSizesAndSigns) {
  const wide::Quad x{-1.5, 2.5, -0.0, 0.0};
  wide::Quad sizes;
  wide::Sizes(x, sizes);
  EXPECT_EQ(Of(sizes), (Four{1.5, 2.5, 0.0, 0.0}));
  EXPECT_FALSE(std::signbit(Of(sizes)[2]));
  wide::Quad signed_like;
  wide::WithSigns(wide::Quad{3.0, 4.0, 5.0, 6.0}, x, signed_like);
  EXPECT_EQ(Of(signed_like), (Four{-3.0, 4.0, -5.0, 6.0}));
}

TEST(WideNumbers, AreKeptWithinALimitEitherWay) {
  wide::Quad x{-3.0, -1.0, 1.5, 2.5};
  wide::Clamp(x, 2.0);
  EXPECT_EQ(Of(x), (Four{-2.0, -1.0, 1.5, 2.0}));
}

}  // namespace
}  // namespace contour
