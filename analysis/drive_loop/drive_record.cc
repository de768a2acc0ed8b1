#include "analysis/drive_loop/drive_record.h"

namespace contour {

void DriveRecorder::Add(const CycleRecord& record) {
  if (axis_ >= record.axes.size()) return;
  const AxisRecord& a = record.axes[axis_];
  const bool held = a.feedback.drive_state == DriveState::kOperationEnabled;
  if (samples_.empty()) {
    if (!held) return;
    first_cycle_ = record.cycle;
  }
  if (record.cycle < first_cycle_) return;
  const auto row = static_cast<std::size_t>(record.cycle - first_cycle_);
  if (row >= samples_.size()) samples_.resize(row + 1);
  DriveSample& s = samples_[row];
  s.position_m = a.position_m;
  s.target_m = a.target_position_rad * radius_m_rad_;
  s.offset_N = a.torque_Nm / radius_m_rad_;
  s.extra_N = a.reference.extra_torque_Nm / radius_m_rad_;
  s.velocity_m_s = a.reference.velocity_m_s;
  s.acceleration_m_s2 = a.reference.acceleration_m_s2;
  s.reported_N = a.feedback.torque_Nm / radius_m_rad_;
  s.good = held && a.feedback.fresh;
}

}  // namespace contour
