#include "analysis/diagnosis/quantification/widen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/prediction_error/common_factor.h"
#include "tests/analysis/support/known_axis.h"

namespace contour::diagnosis {
namespace {

Cause With(const char* kind, const std::string& parameter, const Interval& interval) {
  Cause cause;
  cause.kind = kind;
  cause.parameters[parameter] = interval;
  return cause;
}

class WidenTest : public testing::Test {
 protected:
  WidenTest() { point_.base.assign(axis_.problem.terms.size(), 0.0); }

  Interval Widened(const char* kind, const std::string& parameter, const Interval& interval) const {
    Cause cause = With(kind, parameter, interval);
    WidenIntervals(axis_.problem, point_, cause);
    return cause.parameters.at(parameter);
  }
  static double ModelErrorOf(const char* kind, const std::string& parameter) {
    for (const ModelError& e : *CauseNamed(kind).model_errors)
      if (e.parameter == parameter) return e.sigma_rel;
    return 0.0;
  }

  test::KnownAxis axis_;
  Point point_;
};

TEST_F(WidenTest, TheScatterAndTheModelsErrorAddAsSquares) {
  const double sigma_rel = ModelErrorOf("friction_drift", "change_rel");
  ASSERT_GT(sigma_rel, 0.0);
  const double by = 1.96 * sigma_rel * 0.5;
  // Three and four times the model's error: roots of 10 and 17 of it.
  const Interval i = Widened("friction_drift", "change_rel", {-0.5, -0.5 - 3.0 * by, -0.5 + 4.0 * by});
  EXPECT_EQ(i.value, -0.5);
  EXPECT_NEAR(-0.5 - i.low, std::sqrt(10.0) * by, 1e-12);
  EXPECT_NEAR(i.high + 0.5, std::sqrt(17.0) * by, 1e-12);
}

TEST_F(WidenTest, WhatActsAsItsModelDoesStaysAsItIs) {
  ASSERT_EQ(ModelErrorOf("friction_drift", "time_constant_s"), 0.0);
  const Interval i = Widened("friction_drift", "time_constant_s", {30.0, 20.0, 45.0});
  EXPECT_NEAR(i.low, 20.0, 1e-12);
  EXPECT_NEAR(i.high, 45.0, 1e-12);
}

TEST_F(WidenTest, OfATorqueConstantThePriorsKnowAsMuchAsTheyKnow) {
  const double sigma = FindCommonFactor(axis_.problem, point_).sigma;
  ASSERT_GT(sigma, 0.0);
  const Interval i = Widened("torque_constant", "ratio", {1.2, 1.2, 1.2});
  EXPECT_NEAR(i.high - 1.2, 1.96 * sigma * 1.2, 1e-9);
  EXPECT_NEAR(1.2 - i.low, 1.96 * sigma * 1.2, 1e-9);
}

}  // namespace
}  // namespace contour::diagnosis
