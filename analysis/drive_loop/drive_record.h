#pragma once

#include <cstddef>
#include <vector>

#include "core/cycle_record.h"

namespace contour {

/// One cycle of an axis whose drive closes the position loop. Forces at the table, N = torque / R; positions
/// of the motor, as travel of the table. The offset of a row begins to act one period after its position was
/// latched, its target is for two periods after.
struct DriveSample {
  double position_m = 0.0;
  double target_m = 0.0;
  double offset_N = 0.0;  ///< all of 0x60B2
  double extra_N = 0.0;   ///< what the experiment put on of it
  double velocity_m_s = 0.0;
  double acceleration_m_s2 = 0.0;  ///< of the reference
  double reported_N = 0.0;         ///< by the drive (0x6077), of the same instant as the position
  bool good = false;               ///< the drive held the axis, and its reading is of this cycle
};

/// Cycles of a machine as they come, as the record of one axis. Cycles that were lost leave samples that are
/// not good.
class DriveRecorder {
 public:
  DriveRecorder(std::size_t axis, double radius_m_rad) : axis_(axis), radius_m_rad_(radius_m_rad) {}
  void Add(const CycleRecord& record);
  [[nodiscard]] const std::vector<DriveSample>& samples() const { return samples_; }

 private:
  std::size_t axis_;
  double radius_m_rad_;
  std::vector<DriveSample> samples_;
  std::uint64_t first_cycle_ = 0;
};

}  // namespace contour
