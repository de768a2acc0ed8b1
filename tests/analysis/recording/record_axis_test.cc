#include "analysis/recording/record_axis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour {
namespace {

CycleRecord Cycle(std::uint64_t number, bool on = true, bool fresh = true, bool scale = false) {
  CycleRecord r;
  r.cycle = number;
  r.axes.resize(2);
  AxisRecord& a = r.axes[1];
  a.feedback.drive_state = on ? DriveState::kOperationEnabled : DriveState::kSwitchedOn;
  a.feedback.fresh = fresh;
  a.feedback.position_rad = static_cast<double>(number);
  a.feedback.has_scale = scale;
  a.feedback.table_position_m = 1e-3 * static_cast<double>(number);
  a.torque_Nm = 0.1 * static_cast<double>(number);
  return r;
}

TEST(AxisRecorder, BeginsWithTheFirstCycleInWhichTheDriveIsOn) {
  AxisRecorder recorder(1, 1e-3);
  recorder.Add(Cycle(7, false));
  recorder.Add(Cycle(8));
  recorder.Add(Cycle(9));
  const diagnosis::AxisLog log = recorder.Take();
  EXPECT_EQ(log.command, (std::vector<double>{0.8, 0.9}));
  EXPECT_EQ(log.position, (std::vector<double>{8.0, 9.0}));
  EXPECT_DOUBLE_EQ(log.period_s, 1e-3);
  EXPECT_TRUE(log.table_position_m.empty());
}

TEST(AxisRecorder, LostCyclesAreMissingAndTheDriveGoesOnWithItsCommand) {
  AxisRecorder recorder(1, 1e-3);
  recorder.Add(Cycle(8));
  recorder.Add(Cycle(11));
  EXPECT_DOUBLE_EQ(recorder.seconds(), 2e-3);
  const diagnosis::AxisLog log = recorder.Take();
  EXPECT_EQ(log.present, (std::vector<std::uint8_t>{1, 0, 0, 1}));
  EXPECT_EQ(log.command, (std::vector<double>{0.8, 0.8, 0.8, 11 * 0.1}));
  EXPECT_TRUE(std::isnan(log.position[1]));
  EXPECT_EQ(log.rows, 2U);
  EXPECT_EQ(log.missing, 2U);
}

TEST(AxisRecorder, StaleFeedbackIsNoReadingButItsCommandIsKnown) {
  AxisRecorder recorder(1, 1e-3);
  recorder.Add(Cycle(8));
  recorder.Add(Cycle(9, true, false));
  recorder.Add(Cycle(10, false));
  const diagnosis::AxisLog log = recorder.Take();
  EXPECT_EQ(log.present, (std::vector<std::uint8_t>{1, 0, 0}));
  EXPECT_DOUBLE_EQ(log.command[1], 0.9);
  EXPECT_DOUBLE_EQ(log.command[2], 1.0);
}

TEST(AxisRecorder, KeepsALinearScaleAndIsEmptyAfterwards) {
  AxisRecorder recorder(1, 1e-3);
  recorder.Add(Cycle(1, true, true, true));
  recorder.Add(Cycle(2));
  const diagnosis::AxisLog log = recorder.Take();
  ASSERT_EQ(log.table_position_m.size(), 2U);
  EXPECT_DOUBLE_EQ(log.table_position_m[0], 1e-3);
  EXPECT_TRUE(std::isnan(log.table_position_m[1]));
  EXPECT_EQ(recorder.log().size(), 0U);
}

TEST(AxisRecorder, TakesWhatADriveInCspReportsForTheCommand) {
  // The drive's own loop gives 2 Nm more every cycle; the offset is 0.1 Nm times the cycle. What it reports
  // is both, the offset being that of two cycles before.
  AxisRecorder recorder(1, 1e-3, {true, 1, 0.2e-3});
  for (std::uint64_t cycle = 10; cycle < 20; ++cycle) {
    CycleRecord record = Cycle(cycle);
    const auto n = static_cast<double>(cycle);
    record.axes[1].feedback.torque_Nm = 2.0 * n + 0.1 * (n - 2.0);
    recorder.Add(record);
  }
  const diagnosis::AxisLog log = recorder.Take();
  // Row 5 is cycle 15: its command acts between the readings of cycles 16 and 17.
  EXPECT_NEAR(log.command[5], 1.5 + 2.0 * 16.5 + 0.2 * 2.0, 1e-9);
  // What it is made of is there as well.
  EXPECT_NEAR(log.offset[5], 1.5, 1e-9);
  EXPECT_NEAR(log.reported[5], 2.0 * 15.0 + 1.3, 1e-9);
}

TEST(AxisRecorder, AnAxisThatTheMachineHasNotIsNotRecorded) {
  AxisRecorder recorder(5, 1e-3);
  recorder.Add(Cycle(8));
  EXPECT_EQ(recorder.log().size(), 0U);
}

}  // namespace
}  // namespace contour
