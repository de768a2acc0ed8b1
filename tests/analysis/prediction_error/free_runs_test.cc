#include "analysis/prediction_error/free_runs.h"

#include <gtest/gtest.h>

#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

TEST(FreeRuns, AWorseModelIsFurtherOffOverASecond) {
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

TEST(FreeRuns, WindowsOfTheHalvesShareNoRow) {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  const test::LearntProblem made(test::MakeHiddenAxis(o));
  std::vector<int> seen(made.problem.rows(), 0);
  for (const Parts parts : {Parts::kEven, Parts::kOdd}) {
    const std::vector<Segment> windows = FreeRunWindows(made.problem, parts);
    EXPECT_FALSE(windows.empty());
    for (const Segment& w : windows)
      for (std::size_t k = w.from; k < w.from + w.rows; ++k) seen[k] |= parts == Parts::kEven ? 1 : 2;
  }
  for (const int s : seen) EXPECT_NE(s, 3);
}

}  // namespace
}  // namespace contour::diagnosis
