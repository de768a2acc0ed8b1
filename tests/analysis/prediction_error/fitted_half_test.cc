#include "analysis/prediction_error/fitted_half.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made() {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  return test::MakeHiddenAxis(o);
}

TEST(FittedHalf, EitherHalfSaysNearlyWhatTheWholeDoes) {
  test::LearntProblem made(Made());
  const Fit fit = FitPoint(made.problem, made.point);
  const auto halves = FitHalves(made.problem, fit);
  for (const Point& half : halves) {
    EXPECT_NE(half.base[0], fit.point.base[0]);
    EXPECT_NEAR(half.base[0], fit.point.base[0], 0.02);
  }
  const StatedAxis axis = FittedAxis(made.problem, fit, halves);
  EXPECT_NEAR(axis.motor_inertia, made.problem.stated.motor_inertia * std::exp(fit.point.base[0]), 1e-12);
  EXPECT_GE(axis.sigma.at("inertia"), 0.5 * std::fabs(halves[0].base[0] - halves[1].base[0]));
}

TEST(FittedHalf, PartsCoverTheLog) {
  test::LearntProblem made(Made());
  EXPECT_EQ(PartBegin(made.problem, 0), 0U);
  EXPECT_EQ(PartBegin(made.problem, kHalfParts), made.problem.rows());
}

}  // namespace
}  // namespace contour::diagnosis
