// What follows from thresholds keeps the values that verdicts were judged with.

#include "analysis/diagnosis/tuning/decision_tuning.h"

#include <gtest/gtest.h>

namespace contour::diagnosis {
namespace {

TEST(DecisionTuning, AScanLosesThePenaltyOfTwoAmplitudes) { EXPECT_EQ(ScanPenalty(), 6.0); }

TEST(DecisionTuning, TheTailBeginsWhereTheRateOfItSays) {
  EXPECT_EQ(TailQuantile(), 0.98);
  EXPECT_LT(kThreshold.fitted_quantile, TailQuantile());
}

TEST(DecisionTuning, AnAmplitudeThatIsOffLeavesTheSquareOfItsShare) { EXPECT_EQ(StatedOffDrop(), 1e-4); }

TEST(DecisionTuning, AsManyDrawsLieBelowAnIntervalAsAboveIt) {
  EXPECT_EQ(HeldOutDraw(0.025), 12U);
  EXPECT_EQ(HeldOutDraw(1.0 - 0.025), kAcceptance.held_out_draws - 1 - 12);
}

}  // namespace
}  // namespace contour::diagnosis
