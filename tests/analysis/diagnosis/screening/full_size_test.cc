#include "analysis/diagnosis/screening/full_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

const GridPoint& Best(const std::vector<GridPoint>& points_of_grid) {
  return *std::min_element(points_of_grid.begin(), points_of_grid.end(),
                           [](const GridPoint& a, const GridPoint& b) { return a.cost < b.cost; });
}

TEST(FullSize, TheExcerptLeavesThePlaceThatTheWholeLogLikesBest) {
  test::HiddenOptions o;
  o.seed = 21;
  o.effects = {{"compliance", 0.5}};
  test::LearntProblem l(test::MakeHiddenAxis(o));
  ASSERT_FALSE(l.problem.excerpt.empty());
  const Fit base = FitPoint(l.problem, l.point, {.most_steps = 4, .most_refreshes = 2});
  std::vector<SharedEffect> couplings = CatalogueEffects(l.problem);
  std::erase_if(couplings, [](const SharedEffect& e) { return e->kind != "compliance"; });
  const std::vector<Scored> scored = ScoreEffects(l.problem, base, couplings);
  const std::vector<GridPoint> ahead = FullSize(l.problem, base, "compliance", scored);
  l.problem.excerpt = {};
  const std::vector<GridPoint> whole = FullSize(l.problem, base, "compliance", scored);
  ASSERT_FALSE(ahead.empty());
  // The whole grid has more places below the base than the shortlist has at all.
  EXPECT_LE(ahead.size(), 8U);
  EXPECT_GT(whole.size(), ahead.size());
  EXPECT_DOUBLE_EQ(Best(ahead).cost, Best(whole).cost);
  EXPECT_EQ(Best(ahead).point.effects.back()->label, Best(whole).point.effects.back()->label);
  EXPECT_LT(Best(ahead).cost, base.cost - 100.0);
}

}  // namespace
}  // namespace contour::diagnosis
