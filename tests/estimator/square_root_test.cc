#include "estimator/square_root.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace contour {
namespace {

using square_root::AddRankOne;
using square_root::Sound;
using square_root::Triangulariser;

template <std::size_t N>
std::array<std::array<long double, N>, N> Product(const SquareMatrix<N>& s) {
  std::array<std::array<long double, N>, N> p{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      for (std::size_t k = 0; k < N; ++k) p[i][j] += static_cast<long double>(s[i][k]) * s[j][k];
    }
  }
  return p;
}

template <std::size_t N, std::size_t M>
void CheckRandom(double range_decades) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> decade(-range_decades, range_decades);
  for (int trial = 0; trial < 200; ++trial) {
    Triangulariser<N, M> a{};
    StateVector<N> noise{};
    std::array<std::array<long double, N>, N> expected{};
    std::array<double, N> scale{};
    for (std::size_t i = 0; i < N; ++i) {
      scale[i] = std::pow(10.0, decade(random));
      for (std::size_t k = 0; k < M; ++k) a.row[i][k] = normal(random) * scale[i];
      noise[i] = trial % 3 == 0 ? 0.0 : std::abs(normal(random)) * scale[i];
    }
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) {
        for (std::size_t k = 0; k < M; ++k)
          expected[i][j] += static_cast<long double>(a.row[i][k]) * a.row[j][k];
      }
      expected[i][i] += static_cast<long double>(noise[i]) * noise[i];
    }
    SquareMatrix<N> s;
    for (auto& row : s) row.fill(1e99);
    a.Run(noise, s);
    const auto p = Product<N>(s);
    for (std::size_t i = 0; i < N; ++i) {
      EXPECT_GE(s[i][i], 0.0);
      for (std::size_t j = 0; j < N; ++j) {
        if (j > i) {
          EXPECT_EQ(s[i][j], 0.0);
        }
        const double tolerance =
            1e-14 * static_cast<double>(M) * std::sqrt(static_cast<double>(expected[i][i] * expected[j][j]));
        ASSERT_NEAR(static_cast<double>(p[i][j] - expected[i][j]), 0.0, tolerance) << i << " " << j;
      }
    }
  }
}

TEST(Triangulariser, ReproducesTheProduct) {
  CheckRandom<7, 15>(0.0);
  CheckRandom<7, 7>(0.0);
  CheckRandom<4, 9>(0.0);
  CheckRandom<1, 3>(0.0);
}

TEST(Triangulariser, KeepsItsDigitsWhenStatesDifferByTenDecades) { CheckRandom<7, 15>(5.0); }

TEST(Triangulariser, TakesRowsOfZeros) {
  Triangulariser<3, 7> a{};
  a.row[1][2] = -2.0;
  SquareMatrix<3> s;
  a.Run({}, s);
  const auto p = Product<3>(s);
  EXPECT_EQ(static_cast<double>(p[0][0]), 0.0);
  EXPECT_DOUBLE_EQ(static_cast<double>(p[1][1]), 4.0);
  EXPECT_EQ(static_cast<double>(p[2][2]), 0.0);
}

TEST(Triangulariser, EntriesThatUnderflowDoNoHarm) {
  for (const double tiny : {1e-120, 1e-140, 1e-155, 1e-160, 1e-170, 1e-310}) {
    for (const double sign : {-1.0, 1.0}) {
      Triangulariser<3, 7> a{};
      a.row[0] = {sign * 1e-3, tiny, tiny, 0.0, tiny, 0.0, 0.0};
      a.row[1] = {0.5, 1.0, tiny, 0.0, 0.0, 0.0, 0.0};
      a.row[2] = {tiny, tiny, 0.0, tiny, 0.0, 0.0, 0.0};
      SquareMatrix<3> s;
      a.Run({}, s);
      const auto p = Product<3>(s);
      EXPECT_DOUBLE_EQ(static_cast<double>(p[0][0]), 1e-6) << tiny;
      EXPECT_NEAR(static_cast<double>(p[1][0]), sign * 5e-4, 1e-18) << tiny;
      EXPECT_NEAR(static_cast<double>(p[1][1]), 1.25, 1e-14) << tiny;
      for (const auto& row : s) {
        for (const double v : row) EXPECT_TRUE(std::isfinite(v)) << tiny;
      }
    }
  }
}

TEST(AddRankOne, AddsTheOuterProduct) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (std::size_t first = 0; first < 5; ++first) {
    SquareMatrix<5> s{};
    StateVector<5> w{};
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = 0; j <= i; ++j) s[i][j] = normal(random);
      if (i >= first) w[i] = normal(random);
    }
    auto expected = Product<5>(s);
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = 0; j < 5; ++j) expected[i][j] += static_cast<long double>(w[i]) * w[j];
    }
    AddRankOne<5>(s, w, first);
    const auto p = Product<5>(s);
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = 0; j < 5; ++j) {
        EXPECT_NEAR(static_cast<double>(p[i][j]), static_cast<double>(expected[i][j]), 1e-13);
        if (j > i) {
          EXPECT_EQ(s[i][j], 0.0);
        }
      }
    }
  }
}

TEST(Sound, SeesWhatIsWrong) {
  const StateVector<2> limit{1.0, 10.0};
  EXPECT_TRUE((Sound<2>({1.0, 2.0}, {{{0.5, 0.0}, {1.0, 1.0}}}, limit)));
  EXPECT_FALSE((Sound<2>({std::nan(""), 2.0}, {{{0.5, 0.0}, {1.0, 1.0}}}, limit)));
  EXPECT_FALSE((Sound<2>({1.0, INFINITY}, {{{0.5, 0.0}, {1.0, 1.0}}}, limit)));
  EXPECT_FALSE((Sound<2>({1.0, 2.0}, {{{0.5, 0.0}, {std::nan(""), 1.0}}}, limit)));
  EXPECT_FALSE((Sound<2>({1.0, 2.0}, {{{0.5, 0.0}, {8.0, 8.0}}}, limit)));
}

}  // namespace
}  // namespace contour
