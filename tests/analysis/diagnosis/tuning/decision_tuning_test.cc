// What follows from thresholds keeps the values that verdicts were judged with.

#include "analysis/diagnosis/tuning/decision_tuning.h"

#include <gtest/gtest.h>

#include "analysis/diagnosis/tuning/model_error.h"

namespace contour::diagnosis {
namespace {

TEST(DecisionTuning, AScanLosesThePenaltyOfTwoAmplitudes) { EXPECT_EQ(ScanPenalty(), 6.0); }

TEST(DecisionTuning, EveryBlockOfTheShortestLogHoldsTheMemoryOfItsNoise) {
  EXPECT_EQ(FewestRows(), 60U * 48U);
}

TEST(DecisionTuning, TheModelsOwnErrorsAddMoreWhereFewerAlarmsAreAsked) {
  EXPECT_GT(AllowancePerRow(0.01), AllowancePerRow(0.05));
  EXPECT_GT(AllowancePerRow(0.05), 0.0);
  EXPECT_EQ(AllowancePerRow(1.0), 0.0);
}

TEST(DecisionTuning, AnAmplitudeThatIsOffLeavesTheSquareOfItsShare) { EXPECT_EQ(StatedOffDrop(), 1e-4); }

TEST(DecisionTuning, SlowLogsAreSmoothedOverAsManyRowsAsThoseOf1kHz) {
  EXPECT_DOUBLE_EQ(ResidualSmoothing(1e-3), 1.3);
  EXPECT_DOUBLE_EQ(ResidualSmoothing(0.02), 1.3);
  EXPECT_DOUBLE_EQ(ResidualSmoothing(1e-4), 13.0);
}

TEST(DecisionTuning, AsManyDrawsLieBelowAnIntervalAsAboveIt) {
  EXPECT_EQ(HeldOutDraw(0.025), 37U);
  EXPECT_NEAR(static_cast<double>(HeldOutDraw(1.0 - 0.025)), kThreshold.flip_draws - 1.0 - 37.0, 1.0);
}

}  // namespace
}  // namespace contour::diagnosis
