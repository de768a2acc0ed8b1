#include "analysis/drive_loop/drive_record.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

CycleRecord Cycle(std::uint64_t number, DriveState state, bool fresh) {
  CycleRecord r;
  r.cycle = number;
  r.axes.resize(2);
  AxisRecord& a = r.axes[1];
  a.feedback.drive_state = state;
  a.feedback.fresh = fresh;
  a.position_m = 1e-3 * static_cast<double>(number);
  a.target_position_rad = 2.0;
  a.torque_Nm = 0.5;
  a.feedback.torque_Nm = 0.4;
  a.reference.extra_torque_Nm = 0.1;
  a.reference.velocity_m_s = 0.02;
  a.reference.acceleration_m_s2 = 3.0;
  return r;
}

TEST(DriveRecorder, KeepsForcesAndPositionsAtTheTable) {
  DriveRecorder recorder(1, 1e-3);
  recorder.Add(Cycle(7, DriveState::kOperationEnabled, true));
  ASSERT_EQ(recorder.samples().size(), 1u);
  const DriveSample& s = recorder.samples()[0];
  EXPECT_DOUBLE_EQ(s.position_m, 7e-3);
  EXPECT_DOUBLE_EQ(s.target_m, 2e-3);
  EXPECT_DOUBLE_EQ(s.offset_N, 500.0);
  EXPECT_DOUBLE_EQ(s.extra_N, 100.0);
  EXPECT_DOUBLE_EQ(s.reported_N, 400.0);
  EXPECT_DOUBLE_EQ(s.velocity_m_s, 0.02);
  EXPECT_DOUBLE_EQ(s.acceleration_m_s2, 3.0);
  EXPECT_TRUE(s.good);
}

TEST(DriveRecorder, BeginsWithTheDriveAndMarksWhatIsLostOrStale) {
  DriveRecorder recorder(1, 1e-3);
  recorder.Add(Cycle(5, DriveState::kSwitchedOn, true));
  EXPECT_TRUE(recorder.samples().empty());
  recorder.Add(Cycle(6, DriveState::kOperationEnabled, true));
  recorder.Add(Cycle(9, DriveState::kOperationEnabled, false));
  ASSERT_EQ(recorder.samples().size(), 4u);
  EXPECT_TRUE(recorder.samples()[0].good);
  for (std::size_t k = 1; k < 4; ++k) EXPECT_FALSE(recorder.samples()[k].good) << k;
}

}  // namespace
}  // namespace contour
