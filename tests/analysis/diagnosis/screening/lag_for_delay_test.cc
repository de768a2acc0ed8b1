#include "analysis/diagnosis/screening/lag_for_delay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "tests/analysis/support/known_axis.h"

namespace contour::diagnosis {
namespace {

BaseTerm* Exchange(Problem& problem) {
  const auto term = std::find_if(problem.terms.begin(), problem.terms.end(),
                                 [](const BaseTerm& t) { return t.name == "lag_for_delay"; });
  return term == problem.terms.end() ? nullptr : &*term;
}

Fit At(const Problem& problem, const BaseTerm* exchange, double lag_s) {
  Fit fit;
  fit.point.base.assign(problem.terms.size(), 0.0);
  if (exchange != nullptr) fit.point.base[static_cast<std::size_t>(exchange - problem.terms.data())] = lag_s;
  return fit;
}

TEST(LagForDelay, ACouplingNeverActsAsADelayThatCameWithLessLag) {
  test::KnownAxis axis;
  BaseTerm* const exchange = Exchange(axis.problem);
  ASSERT_NE(exchange, nullptr);
  const double sigma = exchange->sigma;
  EXPECT_FALSE(AdmitCouplings(axis.problem, At(axis.problem, exchange, -1.9 * sigma)));
  EXPECT_FALSE(AdmitCouplings(axis.problem, At(axis.problem, exchange, 1.9 * sigma)));
  EXPECT_EQ(exchange->sigma, sigma);
  EXPECT_TRUE(AdmitCouplings(axis.problem, At(axis.problem, exchange, -2.1 * sigma)));
  EXPECT_LT(exchange->sigma, 0.01 * sigma) << "held at none";
}

TEST(LagForDelay, AnythingUpToACouplingAtHalfTheRateMayBeThere) {
  test::KnownAxis axis;
  BaseTerm* const exchange = Exchange(axis.problem);
  ASSERT_NE(exchange, nullptr);
  const double most = MostLagForDelay(axis.problem, At(axis.problem, exchange, 0.0).point);
  EXPECT_TRUE(AdmitCouplings(axis.problem, At(axis.problem, exchange, 2.1 * exchange->sigma)));
  EXPECT_NEAR(exchange->sigma, 0.5 * most, 1e-9);
  EXPECT_FALSE(AdmitCouplings(axis.problem, At(axis.problem, exchange, 0.9 * most))) << "once";
}

TEST(LagForDelay, AModelWithACouplingHasNoExchange) {
  test::KnownAxis axis({.two_inertia = true});
  ASSERT_EQ(Exchange(axis.problem), nullptr);
  EXPECT_FALSE(AdmitCouplings(axis.problem, At(axis.problem, nullptr, 0.0)));
}

}  // namespace
}  // namespace contour::diagnosis
