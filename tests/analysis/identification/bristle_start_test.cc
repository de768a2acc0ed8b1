#include "analysis/identification/bristle_start.h"

#include <gtest/gtest.h>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::BristleToBeginWith_N_m;
using identify::TableAxis;

TEST(BristleStartTest, ComesBackFromABristleSeveralTimesTooStiff) {
  TableAxis axis = Exactly(PlainAxis());
  const double is_N_m = axis.friction.s0;
  for (const double wrong : {2.8, 1.9, 0.75}) {
    axis.friction.s0 = wrong * is_N_m;
    const double found_N_m = BristleToBeginWith_N_m(axis, {Everything()}, {}, 1);
    EXPECT_NEAR(found_N_m / is_N_m, 1.0, 0.2) << wrong;
  }
}

TEST(BristleStartTest, TakesWhatReversalsSayWhereThatForeseesBest) {
  TableAxis axis = Exactly(PlainAxis());
  const double is_N_m = axis.friction.s0;
  axis.friction.s0 = 1.2 * is_N_m;
  EXPECT_EQ(BristleToBeginWith_N_m(axis, {Everything()}, {0.99 * is_N_m}, 1), 0.99 * is_N_m);
}

TEST(BristleStartTest, TakesWhatIsStatedWhereShakingIsOffByMoreThanTheSeries) {
  TableAxis axis = Exactly(PlainAxis());
  const double is_N_m = axis.friction.s0;
  axis.friction.s0 = 100.0 * is_N_m;
  EXPECT_EQ(BristleToBeginWith_N_m(axis, {Everything()}, {40.0 * is_N_m, 1.3 * is_N_m}, 1), 1.3 * is_N_m);
}

}  // namespace
}  // namespace contour::test
