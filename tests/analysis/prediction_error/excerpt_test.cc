#include "analysis/prediction_error/excerpt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "analysis/prediction_error/fit.h"
#include "analysis/prediction_error/refit.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made(bool two_inertia) {
  test::HiddenOptions o;
  o.seed = 21;
  o.duration_s = 60.0;
  o.two_inertia = two_inertia;
  return test::MakeHiddenAxis(o);
}

// Rows of an excerpt, where they count, are those of a run of the whole log.
void ExpectRowsOfTheWhole(bool two_inertia) {
  const test::LearntProblem l(Made(two_inertia));
  const Excerpt& e = l.problem.excerpt;
  ASSERT_FALSE(e.empty());
  const std::size_t n = l.problem.rows(), m = e.row.size();
  EXPECT_LT(m, 0.4 * static_cast<double>(n));
  const std::vector<double> whole = l.problem.Residuals(std::span(&l.point, 1))[0];
  const std::vector<double> part = l.problem.Residuals(std::span(&l.point, 1), Extent::kExcerpt)[0];
  ASSERT_EQ(part.size(), l.problem.data_size(Extent::kExcerpt));
  double off = 0.0, all = 0.0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (e.counts[i % m] == 0) {
      EXPECT_EQ(part[i], 0.0) << i;
      continue;
    }
    const double expected = std::sqrt(e.per_row) * whole[i / m * n + e.row[i % m]];
    off += std::pow(part[i] - expected, 2);
    all += expected * expected;
  }
  EXPECT_LT(off, 0.01 * all);
  EXPECT_GT(all, static_cast<double>(m));
}

TEST(Excerpt, RowsOfARigidAxisAreThoseOfTheWhole) { ExpectRowsOfTheWhole(false); }
TEST(Excerpt, RowsOfTwoInertiasAreThoseOfTheWhole) { ExpectRowsOfTheWhole(true); }

TEST(Excerpt, AFitOfItEndsNearThatOfTheWhole) {
  const test::LearntProblem l(Made(false));
  const Fit ahead = FitPoint(l.problem, l.point, {.covariance = false}, Extent::kExcerpt);
  const Fit whole = FitPoint(l.problem, l.point);
  const double start = CostAt(l.problem, l.point), there = CostAt(l.problem, ahead.point);
  EXPECT_GT(start - whole.cost, 100.0);
  EXPECT_LT(there - whole.cost, 0.1 * (start - whole.cost));
}

TEST(Excerpt, ThereIsNoneOfAShortLog) {
  test::HiddenOptions o;
  o.duration_s = 10.0;
  const test::HiddenAxis axis = test::MakeHiddenAxis(o);
  Problem problem(axis.log, axis.stated, 1);
  Point start;
  for (const BaseTerm& t : problem.terms) start.base.push_back(t.start);
  problem.LearnOutliers(start);
  EXPECT_TRUE(problem.excerpt.empty());
}

}  // namespace
}  // namespace contour::diagnosis
