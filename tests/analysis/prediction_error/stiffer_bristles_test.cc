#include "analysis/prediction_error/stiffer_bristles.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "analysis/prediction_error/refit.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

/// The stated model is the axis itself, but for its bristle, which is eight times softer.
test::HiddenAxis Made(bool open) {
  test::HiddenOptions o;
  o.seed = 11;
  o.duration_s = 20.0;
  o.parameter_spread = 0.0;
  o.scale = false;
  test::HiddenAxis axis = test::MakeHiddenAxis(o);
  axis.stated.friction.s0 /= 8.0;
  axis.stated.sigma["s0"] = 1.0;
  if (open) axis.stated.open.insert("s0");
  return axis;
}

Fit At(const test::LearntProblem& made, double log_bristle) {
  Fit fit;
  fit.point = made.point;
  for (std::size_t i = 0; i < fit.point.base.size(); ++i)
    if (std::string(made.problem.terms[i].name) == "s0") fit.point.base[i] = log_bristle;
  fit.prior = PriorOf(made.problem, fit.point);
  fit.cost = CostAt(made.problem, fit.point);
  return fit;
}

TEST(FitFromStiffer, ABristleThatWentSofterIsBegunStiffer) {
  const test::LearntProblem made(Made(true));
  Fit fit = At(made, -1.5);
  const double before = fit.cost;
  ASSERT_TRUE(FitFromStiffer(made.problem, fit, {}));
  EXPECT_LT(fit.cost, 0.5 * before);
  for (std::size_t i = 0; i < fit.point.base.size(); ++i)
    if (std::string(made.problem.terms[i].name) == "s0") EXPECT_NEAR(fit.point.base[i], 2.08, 0.3);
}

TEST(FitFromStiffer, OneThatIsAboutWhereItBeganIsLeft) {
  const test::LearntProblem made(Made(true));
  Fit fit = At(made, -0.5);
  EXPECT_FALSE(FitFromStiffer(made.problem, fit, {}));
}

TEST(FitFromStiffer, ABristleThatIsStatedIsLeft) {
  const test::LearntProblem made(Made(false));
  Fit fit = At(made, -1.5);
  EXPECT_FALSE(FitFromStiffer(made.problem, fit, {}));
}

}  // namespace
}  // namespace contour::diagnosis
