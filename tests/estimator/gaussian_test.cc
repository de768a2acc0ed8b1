#include "estimator/gaussian.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/estimator/dense_filter.h"

namespace contour {
namespace {

constexpr InnovationGate kOpen{1e12, 1e12};

Gaussian<5> RandomState(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Gaussian<5> g;
  for (std::size_t i = 0; i < 5; ++i) {
    g.x[i] = normal(random);
    for (std::size_t j = 0; j <= i; ++j) g.s[i][j] = normal(random);
  }
  return g;
}

test::DenseFilter<5> Dense(const Gaussian<5>& g) {
  test::DenseFilter<5> d;
  for (std::size_t i = 0; i < 5; ++i) {
    d.x[i] = g.x[i];
    for (std::size_t j = 0; j < 5; ++j) {
      for (std::size_t k = 0; k < 5; ++k) d.p[i][j] += static_cast<long double>(g.s[i][k]) * g.s[j][k];
    }
  }
  return d;
}

TEST(UpdateFirstState, IsTheKalmanUpdateWithAnyStatesKept) {
  std::mt19937 random(11);
  for (unsigned kept = 0; kept < 32; ++kept) {
    Gaussian<5> g = RandomState(random);
    test::DenseFilter<5> d = Dense(g);
    StateMask<5> moves{};
    for (std::size_t i = 0; i < 5; ++i) moves[i] = ((kept >> i) & 1U) == 0U;
    Innovation innovation;
    ASSERT_EQ(UpdateFirstState<5>(g, 0.7, 0.3, kOpen, moves, innovation), UpdateResult::kOk);
    d.UpdateState0(0.7, 0.3, moves);
    const auto p = Dense(g).p;
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(g.x[i], static_cast<double>(d.x[i]), 1e-13) << kept;
      for (std::size_t j = 0; j < 5; ++j) {
        EXPECT_NEAR(static_cast<double>(p[i][j]), static_cast<double>(d.p[i][j]), 1e-12) << kept;
        if (j > i) {
          EXPECT_EQ(g.s[i][j], 0.0);
        }
      }
    }
  }
}

TEST(UpdateFirstState, SaysWhatTheInnovationWas) {
  Gaussian<2> g;
  g.x = {1.0, 0.0};
  g.s = {{{3.0, 0.0}, {1.0, 1.0}}};
  Innovation innovation;
  UpdateFirstState<2>(g, 1.5, 4.0, kOpen, AllStates<2>(), innovation);
  EXPECT_DOUBLE_EQ(innovation.value, 0.5);
  EXPECT_DOUBLE_EQ(innovation.std, 5.0);
}

TEST(UpdateFirstState, TheGateNeedsBothSigmasAndDistance) {
  const auto result = [](double y, InnovationGate gate) {
    Gaussian<2> g;
    g.s = {{{3.0, 0.0}, {1.0, 1.0}}};
    const Gaussian<2> before = g;
    Innovation innovation;
    const auto r = UpdateFirstState<2>(g, y, 4.0, gate, AllStates<2>(), innovation);
    EXPECT_EQ(r == UpdateResult::kGated, g.x == before.x && g.s == before.s);
    return r;
  };
  EXPECT_EQ(result(24.9, {5.0, 0.0}), UpdateResult::kOk);
  EXPECT_EQ(result(25.1, {5.0, 0.0}), UpdateResult::kGated);
  EXPECT_EQ(result(-25.1, {5.0, 0.0}), UpdateResult::kGated);
  EXPECT_EQ(result(25.1, {5.0, 30.0}), UpdateResult::kOk);
  EXPECT_EQ(result(1e6, {5.0, 30.0}), UpdateResult::kGated);
  EXPECT_EQ(result(std::nan(""), {5.0, 30.0}), UpdateResult::kGated);
}

TEST(Gaussian, StandardDeviationOfACombination) {
  Gaussian<3> g;
  g.s = {{{1.0, 0.0, 0.0}, {2.0, 3.0, 0.0}, {-1.0, 4.0, 2.0}}};
  // P = S S^T; c^T P c with c = (1, 2, -1): the columns of c^T S are 6, 2, -2.
  EXPECT_DOUBLE_EQ(g.Std({1.0, 2.0, -1.0}), std::sqrt(36.0 + 4.0 + 4.0));
  EXPECT_DOUBLE_EQ(g.Variance(2), 21.0);
}

}  // namespace
}  // namespace contour
