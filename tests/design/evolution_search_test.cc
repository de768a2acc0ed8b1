#include "design/evolution_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

double Rosenbrock(const std::vector<double>& unit) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < unit.size(); ++i) {
    const double x = 4.0 * unit[i] - 2.0, y = 4.0 * unit[i + 1] - 2.0;
    sum += 100.0 * std::pow(y - x * x, 2) + std::pow(1.0 - x, 2);
  }
  return sum;
}

/// Axes from 1 to 1000 in length, none along a coordinate.
double Ellipsoid(const std::vector<double>& unit) {
  const std::size_t n = unit.size();
  double sum = 0.0, mean = 0.0;
  for (const double x : unit) mean += (x - 0.4) / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double turned = unit[i] - 0.4 - 2.0 * mean;  // a reflection
    sum += std::pow(10.0, 6.0 * static_cast<double>(i) / static_cast<double>(n - 1)) * turned * turned;
  }
  return sum;
}

TEST(EvolutionSearch, FollowsTheValleyOfRosenbrock) {
  const SearchResult r =
      EvolutionSearch(Rosenbrock, std::vector<double>(5, 0.3), {.first_step = 0.1, .evaluations = 4000});
  EXPECT_LT(r.cost, 1e-9);
  for (const double x : r.best) EXPECT_NEAR(x, 0.75, 1e-4);
}

TEST(EvolutionSearch, LearnsTheAxesOfAnIllConditionedEllipsoid) {
  const std::vector<double> start(9, 0.6);
  const SearchResult wide = EvolutionSearch(Ellipsoid, start, {.first_step = 0.1, .evaluations = 12000});
  EXPECT_LT(wide.cost, 1e-9);
  const SearchResult simplex = SimplexSearch(Ellipsoid, start, 12000);
  EXPECT_LT(wide.cost, simplex.cost);
}

TEST(EvolutionSearch, FindsWhatLiesOnTheBorder) {
  const auto slope = [](const std::vector<double>& x) { return x[0] + (x[1] - 0.5) * (x[1] - 0.5); };
  const SearchResult r = EvolutionSearch(slope, {0.5, 0.2}, {.first_step = 0.1, .evaluations = 400});
  EXPECT_NEAR(r.best[0], 0.0, 1e-3);
  EXPECT_NEAR(r.best[1], 0.5, 1e-2);
}

TEST(EvolutionSearch, IsTheSameForTheSameSeedAndSpendsNoMoreThanItsBudget) {
  const std::vector<double> start(5, 0.3);
  const auto run = [&](std::uint64_t seed) {
    return EvolutionSearch(Rosenbrock, start, {.first_step = 0.1, .evaluations = 300, .seed = seed});
  };
  EXPECT_EQ(run(7).best, run(7).best);
  EXPECT_NE(run(7).best, run(8).best);
  EXPECT_LE(run(7).evaluations, 300);
}

TEST(PortableRandom, IsNormalAndKnown) {
  PortableRandom random(1);
  double sum = 0.0, square = 0.0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.Normal();
    sum += x;
    square += x * x;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.03);
  EXPECT_NEAR(square / kCount, 1.0, 0.05);
  // The first number of splitmix64 from 1234567, of its reference implementation.
  EXPECT_DOUBLE_EQ(PortableRandom(1234567).Uniform(),
                   static_cast<double>(6457827717110365317ULL >> 11) * 0x1.0p-53);
}

}  // namespace
}  // namespace contour
