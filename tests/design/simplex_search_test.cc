#include "design/simplex_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

using Point = std::vector<double>;

TEST(SimplexSearch, FindsTheBottomOfACurvedValley) {
  // Rosenbrock's valley in the unit box, bottom at (0.6, 0.6).
  const auto cost = [](const Point& p) {
    const double x = p[0] / 0.6, y = p[1] / 0.6;
    return 100.0 * std::pow(y - x * x, 2) + std::pow(1.0 - x, 2);
  };
  const SearchResult r = SimplexSearch(cost, {0.1, 0.9}, 300);
  EXPECT_EQ(r.evaluations, 300);
  EXPECT_LT(r.cost, 1e-4);
  EXPECT_NEAR(r.best[0], 0.6, 0.02);
  EXPECT_NEAR(r.best[1], 0.6, 0.02);
}

TEST(SimplexSearch, StaysInTheBoxAndFindsItsCorner) {
  const auto cost = [](const Point& p) {
    for (const double x : p) EXPECT_TRUE(x >= 0.0 && x <= 1.0);
    return p[0] - 2.0 * p[1] + std::abs(p[2] - 0.3);
  };
  const SearchResult r = SimplexSearch(cost, {0.5, 0.5, 0.5}, 150);
  EXPECT_NEAR(r.best[0], 0.0, 0.01);
  EXPECT_NEAR(r.best[1], 1.0, 0.01);
  EXPECT_NEAR(r.best[2], 0.3, 0.05);
}

TEST(SimplexSearch, NeverWorseThanTheStartAndKeepsItsBudget) {
  int calls = 0;
  const auto cost = [&](const Point& p) {
    ++calls;
    return std::abs(p[0] - 0.5) < 1e-12 ? 0.0 : 1.0 + p[0];
  };
  for (const int budget : {1, 2, 7, 50}) {
    calls = 0;
    const SearchResult r = SimplexSearch(cost, {0.5, 0.2}, budget);
    EXPECT_EQ(calls, budget);
    EXPECT_EQ(r.cost, 0.0);
  }
}

}  // namespace
}  // namespace contour
