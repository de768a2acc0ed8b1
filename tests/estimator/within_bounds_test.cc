#include "estimator/within_bounds.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace contour {
namespace {

constexpr std::size_t kSize = 6;
constexpr int kRows = 6;
using Within = WithinBounds<kSize>;
using Vector = Eigen::Matrix<double, kRows, 1>;
using Square = Eigen::Matrix<double, kRows, kRows>;

struct Problem {
  Square covariance;
  Vector mean;
  Within::Row bound{};  ///< the first value has none
};

/// Values of as different sizes as a zero in metres and a slope, correlated as little or as much as wanted.
Problem Random(std::mt19937& random, double correlation) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Square root;
  Vector scale;
  for (double& element : root.reshaped()) element = normal(random);
  for (double& element : scale) element = std::pow(10.0, -8.0 * uniform(random));
  const Vector common = root.col(0);
  for (int j = 1; j < kRows; ++j) root.col(j) = (1.0 - correlation) * root.col(j) + correlation * common;
  Problem p;
  p.covariance =
      scale.asDiagonal() * (root * root.transpose() + 1e-6 * Square::Identity()) * scale.asDiagonal();
  for (int i = 0; i < kRows; ++i) {
    const double std = std::sqrt(p.covariance(i, i));
    p.mean(i) = 4.0 * std * normal(random);
    p.bound.at(static_cast<std::size_t>(i)) =
        i == 0 ? std::numeric_limits<double>::infinity() : std * (3.0 * uniform(random) + 1e-3);
  }
  return p;
}

/// Every choice of which values are at which bound, and the best of those that keep all: 3^5 of them. In
/// standard deviations, so that no value is too small to be told from rounding.
Vector Reference(const Problem& p, int& at_bounds) {
  const Vector own = p.covariance.diagonal().cwiseSqrt();
  const Square correlation = own.cwiseInverse().asDiagonal() * p.covariance * own.cwiseInverse().asDiagonal();
  const Eigen::LDLT<Square> likely(correlation);
  Vector best = Vector::Constant(std::numeric_limits<double>::quiet_NaN());
  double least = std::numeric_limits<double>::infinity();
  int choices = 1;
  for (int i = 1; i < kRows; ++i) choices *= 3;
  for (int choice = 0; choice < choices; ++choice) {
    std::vector<int> held;
    std::vector<double> apart;
    for (int i = 1, rest = choice; i < kRows; ++i, rest /= 3)
      if (rest % 3 != 0) {
        held.push_back(i);
        apart.push_back(((rest % 3 == 1 ? 1.0 : -1.0) * p.bound.at(static_cast<std::size_t>(i)) - p.mean(i)) /
                        own(i));
      }
    Vector moved = Vector::Zero();
    if (!held.empty()) {
      const Eigen::Map<Eigen::VectorXd> to(apart.data(), static_cast<Eigen::Index>(apart.size()));
      const Eigen::MatrixXd among = correlation(held, held);
      moved = correlation(Eigen::all, held) * among.ldlt().solve(to);
    }
    const Vector x = p.mean + own.cwiseProduct(moved);
    bool within = true;
    for (int i = 1; i < kRows; ++i)
      within = within && std::abs(x(i)) <= p.bound.at(static_cast<std::size_t>(i)) + 1e-9 * own(i);
    if (const double cost = moved.dot(likely.solve(moved)); within && cost < least) {
      least = cost;
      best = x;
      at_bounds = static_cast<int>(held.size());
    }
  }
  return best;
}

TEST(WithinBounds, IsTheBestOfAllChoicesOfBoundsOnRandomProblems) {
  std::mt19937 random(7);
  std::array<int, kSize> count{};
  for (int n = 0; n < 2000; ++n) {
    const Problem p = Random(random, n % 4 * 0.3);
    Within::Matrix covariance{};
    Within::Row value{};
    for (int i = 0; i < kRows; ++i) {
      value.at(static_cast<std::size_t>(i)) = p.mean(i);
      for (int j = 0; j < kRows; ++j)
        covariance.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j)) = p.covariance(i, j);
    }
    ASSERT_TRUE(Within(covariance, p.bound).Move(value)) << n;
    int at_bounds = 0;
    const Vector best = Reference(p, at_bounds);
    ++count.at(static_cast<std::size_t>(at_bounds));
    for (int i = 0; i < kRows; ++i) {
      const double found = value.at(static_cast<std::size_t>(i));
      ASSERT_LE(std::abs(found), p.bound.at(static_cast<std::size_t>(i))) << n;
      ASSERT_NEAR(found, best(i), 1e-6 * std::sqrt(p.covariance(i, i))) << n << ": value " << i;
    }
  }
  // One to five at their bounds at once.
  for (std::size_t held = 1; held < kSize; ++held) EXPECT_GT(count[held], 20) << held;
}

TEST(WithinBounds, WhatIsWithinStays) {
  const Within::Matrix covariance{Within::Row{4.0, 1.0},
                                  Within::Row{1.0, 2.0},
                                  Within::Row{0.0, 0.0, 1.0},
                                  Within::Row{0.0, 0.0, 0.0, 1.0},
                                  Within::Row{0.0, 0.0, 0.0, 0.0, 1.0},
                                  Within::Row{0.0, 0.0, 0.0, 0.0, 0.0, 1.0}};
  const Within::Row bound{9.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  Within::Row value{7.0, -1.0, 0.5, 1.0, 0.0, -0.3};
  const Within::Row before = value;
  EXPECT_TRUE(Within(covariance, bound).Move(value));
  EXPECT_EQ(value, before);
}

// Two values that cannot be told apart: their sum is known, and one bound is enough to hold both.
TEST(WithinBounds, ValuesThatOnlyTheirSumIsKnownOfKeepTheirBounds) {
  Within::Matrix covariance{};
  for (std::size_t i = 0; i < kSize; ++i) covariance[i][i] = 1.0;
  covariance[1][2] = covariance[2][1] = 1.0;
  Within::Row bound{};
  bound.fill(2.0);
  Within::Row value{0.0, 3.0, 4.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(Within(covariance, bound).Move(value));
  EXPECT_NEAR(value[1], 1.0, 1e-9);
  EXPECT_NEAR(value[2], 2.0, 1e-9);
}

// A value that nothing is known to be wrong of, but which lies outside: it is cut off, and that is said.
TEST(WithinBounds, WhatCannotMoveIsCutOff) {
  Within::Matrix covariance{};
  for (std::size_t i = 0; i < kSize; ++i) covariance[i][i] = 1.0;
  covariance[1][2] = covariance[2][1] = 1.0;
  Within::Row bound{};
  bound.fill(2.0);
  Within::Row value{0.0, 9.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(Within(covariance, bound).Move(value));
  EXPECT_EQ(value[1], 2.0);
  EXPECT_EQ(value[2], -2.0);
}

}  // namespace
}  // namespace contour
