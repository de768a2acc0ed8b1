#include "analysis/identification/basins.h"

#include <gtest/gtest.h>

#include <vector>

namespace contour::test {
namespace {

using identify::Basins;

TEST(BasinsTest, AreLowerThanTheirNeighboursTheLowestFirst) {
  EXPECT_EQ(Basins(std::vector{3.0, 1.0, 2.0, 0.0, 5.0, 4.0}), (std::vector<std::size_t>{3, 1, 5}));
  EXPECT_EQ(Basins(std::vector{1.0, 2.0, 3.0}), (std::vector<std::size_t>{0}));
  EXPECT_EQ(Basins(std::vector{2.0, 1.0, 1.0, 2.0}), (std::vector<std::size_t>{1})) << "a flat bottom is one";
  EXPECT_EQ(Basins(std::vector{3.0, 2.0, 2.0, 1.0, 4.0}), (std::vector<std::size_t>{3}))
      << "a step of a slope is none";
  EXPECT_EQ(Basins(std::vector{1.0}), (std::vector<std::size_t>{0}));
  EXPECT_TRUE(Basins({}).empty());
}

// Logarithms of the errors of a table of 300 kg whose part swings at 57 Hz (the fifth place is 56, the sixth
// 60 Hz), with a part tried from 41 to 446 Hz: far above all that shakes it, it is as good as none.
TEST(BasinsTest, APlateauDoesNotCrowdOutWhereAPartSwings) {
  const std::vector errors{-17.39, -17.46, -17.96, -17.49, -17.45, -18.03, -17.43, -17.75,
                           -17.36, -17.59, -17.37, -17.63, -17.29, -17.45, -17.58, -17.71,
                           -17.71, -17.83, -17.87, -17.93, -17.97, -18.00, -18.01, -18.02,
                           -18.02, -18.03, -18.03, -18.03, -18.04, -18.04, -18.04, -18.04};
  const std::vector<std::size_t> basins = Basins(errors);
  ASSERT_GE(basins.size(), 2U);
  EXPECT_EQ(basins[0], 28U);
  EXPECT_EQ(basins[1], 5U);
}

}  // namespace
}  // namespace contour::test
