#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "analysis/prediction_error/problem.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis WithScale() {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  o.scale = true;
  return test::MakeHiddenAxis(o);
}

// Where the scale reads nothing its residual is nothing, and what it reads all the time is where it was put.
TEST(ProblemScale, CountsFromTheMeanOfTheRowsThatCount) {
  test::HiddenAxis axis = WithScale();
  for (std::size_t k = 3000; k < 3100; ++k)
    axis.log.table_position_m[k] = std::numeric_limits<double>::quiet_NaN();
  test::HiddenAxis moved = axis;
  for (double& x : moved.log.table_position_m) x += 0.001;
  const Problem problem(axis.log, axis.stated, 1), other(moved.log, moved.stated, 1);
  const AxisModel models[] = {problem.nominal, problem.nominal};
  const std::vector<std::vector<double>> raw = problem.Raw(std::span(models), Extent::kWhole);
  const std::size_t n = problem.rows();
  ASSERT_EQ(raw[0].size(), 2 * n);
  EXPECT_EQ(raw[0], raw[1]);
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double e = raw[0][n + k];
    sum += e;
    if (problem.counted[k] == 0 || (k >= 3000 && k < 3100)) {
      EXPECT_EQ(e, 0.0) << k;
    }
  }
  EXPECT_NEAR(sum / static_cast<double>(n), 0.0, 1e-12);
  const std::vector<double> shifted = other.Raw(std::span(models).first(1), Extent::kWhole)[0];
  for (std::size_t k = n; k < 2 * n; ++k) ASSERT_NEAR(shifted[k], raw[0][k], 1e-10) << k;
}

}  // namespace
}  // namespace contour::diagnosis
