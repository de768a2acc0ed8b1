#include "analysis/prediction_error/refit.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(Refit, OnOtherRowsAFitThatGoesOnEndsWhereOneThatBeginsThereDoes) {
  Problem first_half = Made().problem;
  for (std::size_t k = first_half.rows() / 2; k < first_half.rows(); ++k) {
    first_half.counted[k] = 0;
    first_half.root_weight[k] = 0.0;
  }
  const Fit whole = FitPoint(Made().problem, Made().point);
  const Fit anew = FitPoint(first_half, whole.point), on = FitFrom(first_half, whole, {});
  EXPECT_LT(on.cost, 0.6 * whole.cost);
  EXPECT_NEAR(on.cost, anew.cost, 1.0);
  for (std::size_t i = 0; i < on.point.base.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(on.point.base[i], anew.point.base[i], 0.5 * std::sqrt(anew.covariance(at, at)))
        << first_half.terms[i].name;
  }
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
