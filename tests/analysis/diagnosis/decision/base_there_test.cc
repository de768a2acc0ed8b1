#include "analysis/diagnosis/decision/base_there.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "analysis/diagnosis/screening/score.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

class BaseThereTest : public testing::Test {
 protected:
  // A torque of 0.3 Fc that the model does not have.
  test::FittedAxis axis_{{{"constant_torque", 0.3, 0.0, 0.0, 0.0}}};
};

TEST_F(BaseThereTest, ABaseThatLiesWhereTheHypothesisDoesExplainsIt) {
  const Hypothesis torque{.fit = axis_.With(axis_.Of("constant_torque"))};
  Fit current = axis_.base;
  EXPECT_FALSE(BaseLiesThere(axis_.problem, torque, FitEffort{}, current)) << "no base has a torque";
  EXPECT_EQ(current.cost, axis_.base.cost);
  // As if the base at hand had ended higher, and only that made the drop.
  current.cost += 10.0 * (axis_.base.cost - torque.fit.cost);
  EXPECT_TRUE(BaseLiesThere(axis_.problem, torque, FitEffort{}, current));
  EXPECT_NEAR(current.cost, axis_.base.cost, 1.0);
  EXPECT_TRUE(current.point.effects.empty());
}

TEST(MayLieLower, WhatPromisesToOrSaysNothing) {
  const auto fit = [](double cost, double promised) {
    Fit out;
    out.cost = cost;
    out.promised = promised;
    return out;
  };
  const Fit here = fit(1000.0, 0.0);
  EXPECT_FALSE(MayLieLower(fit(1000.0, 0.0), here, 1.0, 50.0)) << "the same place";
  EXPECT_FALSE(MayLieLower(fit(1020.0, 10.0), here, 1.0, 50.0)) << "above, and stays above";
  EXPECT_TRUE(MayLieLower(fit(1020.0, 30.0), here, 1.0, 50.0)) << "promises to end below";
  EXPECT_TRUE(MayLieLower(fit(990.0, 0.0), here, 1.0, 50.0)) << "below";
  EXPECT_TRUE(MayLieLower(fit(1e6, 0.0), here, 1.0, 50.0)) << "led astray by sensitivities that do not serve";
  EXPECT_TRUE(MayLieLower(fit(std::nan(""), 0.0), here, 1.0, 50.0));
}

TEST_F(BaseThereTest, NumbersThatAHypothesisFreesAreWhereTheBaseBegins) {
  // 8 stated deviations off in the hypothesis: without steps the base has them, and its prior.
  Hypothesis lag{.fit = axis_.With(axis_.Of("current_lag"))};
  const std::size_t term = FreedTerms(axis_.problem, "current_lag")[0];
  lag.fit.point.amplitudes.back()[0] = 8.0 * axis_.problem.terms[term].sigma;
  lag.fit.cost = 0.0;
  Fit current = axis_.base;
  current.cost = 1e9;
  FitEffort none;
  none.most_steps = 0;
  ASSERT_TRUE(BaseLiesThere(axis_.problem, lag, none, current));
  EXPECT_NEAR(current.point.base[term], lag.fit.point.base[term] + 8.0 * axis_.problem.terms[term].sigma,
              1e-12);
}

}  // namespace
}  // namespace contour::diagnosis
