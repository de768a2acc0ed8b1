#include "analysis/identification/linear_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::LinearStep;
using identify::Over;
using identify::PeriodSteps;
using identify::TableAxis;

TEST(LinearStepTest, TwoHalvesAreTheWhole) {
  const TableAxis axis = Exactly(PlainAxis());
  const LinearStep half = Over(axis, 300.0, 0.1e-3), whole = Over(axis, 300.0, 0.2e-3);
  EXPECT_TRUE(whole.a.isApprox(half.a * half.a, 1e-10));
  EXPECT_TRUE(whole.table.isApprox(half.a * half.table + half.table, 1e-9));
  EXPECT_NEAR(whole.lag_left, half.lag_left * half.lag_left, 1e-12);
}

TEST(LinearStepTest, TheTorqueComesBehindTheLag) {
  TableAxis axis = Exactly(PlainAxis());
  axis.lag_s = 0.5e-3;
  const LinearStep step = Over(axis, 0.0, 0.2e-3);
  EXPECT_NEAR(step.lag_left, std::exp(-0.4), 1e-9);
  // A force that is there already and one that stays commanded are the force at once.
  EXPECT_TRUE((step.delayed + step.command).isApprox(step.motor, 1e-6));
}

TEST(LinearStepTest, ADelayCutsOneSubStepOfThePeriod) {
  TableAxis axis = Exactly(PlainAxis());
  axis.delay_s = 1.25e-3;
  const PeriodSteps steps = identify::StepsOf(axis, 1e-3, 5);
  EXPECT_EQ(steps.whole_delay, 1U);
  double sum_s = 0.0, older_s = 0.0;
  int cut = 0;
  for (const PeriodSteps::Piece& piece : steps.pieces) {
    sum_s += piece.step_s;
    if (piece.older) older_s += piece.step_s;
    cut += piece.ends_substep ? 0 : 1;
  }
  EXPECT_NEAR(sum_s, 1e-3, 1e-12);
  EXPECT_NEAR(older_s, 0.25e-3, 1e-12);
  EXPECT_EQ(cut, 1);
  EXPECT_TRUE(steps.SameCuts(steps));
  axis.delay_s = 1.45e-3;
  EXPECT_FALSE(steps.SameCuts(identify::StepsOf(axis, 1e-3, 5)));
}

}  // namespace
}  // namespace contour::test
