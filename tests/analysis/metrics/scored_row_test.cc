#include "analysis/metrics/scored_row.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

CycleRecord Record() {
  CycleRecord r;
  r.path_time_s = 1.25;
  r.axes.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    AxisRecord& a = r.axes[i];
    a.reference.position_m = 0.1 + static_cast<double>(i);
    a.position_m = 0.2 + static_cast<double>(i);
    a.estimate.friction_N = 30.0 + static_cast<double>(i);
    a.feedback.table_position_m = 0.3;
  }
  r.axes[1].feedback.has_scale = true;
  r.axes[1].limit = Reason::kTorqueLimit;
  return r;
}

TEST(ScoredRow, HoldsWhatTheRecordSaysOfEachAxis) {
  const ScoredRow row = RowOf(Record(), true);
  EXPECT_DOUBLE_EQ(row.path_time_s, 1.25);
  ASSERT_EQ(row.axes.size(), 2U);
  EXPECT_DOUBLE_EQ(row.axes[1].reference_m, 1.1);
  EXPECT_DOUBLE_EQ(row.axes[1].encoder_m, 1.2);
  EXPECT_DOUBLE_EQ(row.axes[1].friction_estimate_N, 31.0);
  EXPECT_TRUE(row.axes[1].torque_saturated);
  EXPECT_FALSE(row.axes[0].torque_saturated);
}

TEST(ScoredRow, TheTableIsKnownByAScaleOnlyAndFrictionByAnEstimatorOnly) {
  const ScoredRow row = RowOf(Record(), false);
  EXPECT_TRUE(std::isnan(row.axes[0].table_m));
  EXPECT_DOUBLE_EQ(row.axes[1].table_m, 0.3);
  for (const ScoredAxis& a : row.axes) {
    EXPECT_TRUE(std::isnan(a.friction_estimate_N));
    EXPECT_TRUE(std::isnan(a.friction_truth_N));
  }
}

}  // namespace
}  // namespace contour
