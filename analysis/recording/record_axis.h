#pragma once

#include <cstdint>
#include <optional>

#include "analysis/recording/axis_log.h"
#include "core/cycle_record.h"

namespace contour {

/// Cycles of a machine as they come, as the record of one axis. Cycle k holds the position that SYNC k-1
/// latched and the torque computed from it, which acts one period later: AxisLog's timing with a delay of
/// one.
class AxisRecorder {
 public:
  AxisRecorder(std::size_t axis, double period_s);
  void Add(const CycleRecord& record);
  [[nodiscard]] const diagnosis::AxisLog& log() const { return log_; }
  diagnosis::AxisLog Take();
  /// Time recorded, with the drive on.
  [[nodiscard]] double seconds() const;

 private:
  std::size_t axis_;
  diagnosis::AxisLog log_;
  std::optional<std::uint64_t> first_cycle_;
};

}  // namespace contour
