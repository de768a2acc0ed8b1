#include "analysis/prediction_error/refit.h"

#include <gtest/gtest.h>

#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Options() {
  test::HiddenOptions o;
  o.seed = 11;
  o.duration_s = 20.0;
  o.parameter_spread = 0.0;
  o.scale = false;
  return o;
}

/// The stated model is the axis itself.
const test::LearntProblem& Made() {
  static const test::LearntProblem made(test::MakeHiddenAxis(Options()));
  return made;
}

TEST(Refit, RewhitenedUnderTheSameNoiseItIsTheSame) {
  Fit fit = FitPoint(Made().problem, Made().point);
  const double cost = fit.cost;
  const Eigen::MatrixXd normal = fit.normal;
  Rewhiten(Made().problem, fit);
  EXPECT_NEAR(fit.cost, cost, 1e-9 * cost);
  EXPECT_LT((fit.normal - normal).norm(), 0.01 * normal.norm());
}

TEST(Refit, AFitNearItsStatedNumbersIsNotBegunAgain) {
  Fit fit = FitPoint(Made().problem, Made().point);
  EXPECT_FALSE(FitFromStated(Made().problem, fit, {}));
}

TEST(Refit, AFitThatIsFarFromItsStatedNumbersGoesBackWhereThatIsBetter) {
  const Problem& problem = Made().problem;
  Fit astray;
  astray.point = Made().point;
  for (std::size_t i = 0; i < astray.point.base.size(); ++i)
    if (!problem.terms[i].nuisance) astray.point.base[i] = 6.0 * problem.terms[i].sigma;
  astray.prior = PriorOf(problem, astray.point);
  astray.cost = CostAt(problem, astray.point);
  const double before = astray.cost;
  EXPECT_TRUE(FitFromStated(problem, astray, {}));
  EXPECT_LT(astray.cost, 0.5 * before);
}

}  // namespace
}  // namespace contour::diagnosis
