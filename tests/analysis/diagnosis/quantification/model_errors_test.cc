#include "analysis/diagnosis/quantification/model_errors.h"

#include <gtest/gtest.h>

#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

TEST(ModelErrors, AWorseModelIsFurtherOffOverASecond) {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  o.parameter_spread = 0.0;
  test::LearntProblem made(test::MakeHiddenAxis(o));
  const AxisModel good = made.problem.Build(made.point);
  AxisModel bad = good;
  bad.friction.Fc_plus *= 1.2;
  const double near = FreeRunError(made.problem, good, 1.0, 0, made.problem.rows());
  EXPECT_GT(near, 0.0);
  EXPECT_GT(FreeRunError(made.problem, bad, 1.0, 0, made.problem.rows()), 2.0 * near);
}

}  // namespace
}  // namespace contour::diagnosis
