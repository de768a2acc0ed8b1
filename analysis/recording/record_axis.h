#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/recording/axis_log.h"
#include "core/cycle_record.h"

namespace contour {

/// Where the torque of a record comes from: what was commanded, or, where the drive closes the loop (csp),
/// what it reported.
struct RecordedTorque {
  bool reported = false;
  std::size_t delay_cycles = 1;  ///< of the offset that was sent to the drive besides
  double lag_s = 0.0;            ///< of the current loop
};

/// Cycles of a machine as they come, as the record of one axis. Cycle k holds the position that SYNC k-1
/// latched and the torque computed from it, which acts one period later: AxisLog's timing with a delay of
/// one.
class AxisRecorder {
 public:
  AxisRecorder(std::size_t axis, double period_s, const RecordedTorque& torque = {});
  void Add(const CycleRecord& record);
  [[nodiscard]] const diagnosis::AxisLog& log() const { return log_; }
  diagnosis::AxisLog Take();
  /// Time recorded, with the drive on.
  [[nodiscard]] double seconds() const;

 private:
  void CommandFromReports();

  std::size_t axis_;
  RecordedTorque torque_;
  std::vector<double> reported_Nm_;
  diagnosis::AxisLog log_;
  std::optional<std::uint64_t> first_cycle_;
};

}  // namespace contour
