#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/cycle_record.h"
#include "daemon/telemetry/timing_histogram.h"

namespace contour {

/// Where the drive of an axis is, to know its feedback by.
struct FeedbackSource {
  std::uint8_t bus = 0;
  std::uint16_t frame_id = 0;  ///< COB-ID of its answer to SYNC
};

/// How the cycles kept their time, and the drives theirs: causes of late cycles, times of the stages, waits
/// for feedback. Fed with every cycle; what it counts it counts in full, only its messages are limited.
class CycleHealth {
 public:
  explicit CycleHealth(std::vector<std::string> axis_names) : axes_(axis_names.size()), names_(axis_names) {}
  /// Whose answers to watch for; one per axis.
  void Watch(std::vector<FeedbackSource> sources) { sources_ = std::move(sources); }

  void Add(const CycleEntry& entry);

  struct AxisSummary {
    std::uint64_t stale_cycles = 0;  ///< without its feedback at the grid point, since it has first answered
    TimingSummary response;          ///< from the frames sent to its answer
  };
  struct Summary {
    std::uint64_t late_cycles = 0;
    std::array<std::uint64_t, kLateCauses> causes{};
    std::uint64_t last_late_cycle = 0;
    LateCause last_cause = LateCause::kNone;
    double last_late_us = 0.0;  ///< beyond the grid point
    TimingSummary wakeup_late, receiving, estimating, deciding, computing, sending, sent;
    std::uint64_t page_faults = 0;  ///< after warm-up
    std::uint64_t involuntary_switches = 0;
    std::vector<AxisSummary> axes;
  };
  [[nodiscard]] Summary summary() const;

  /// What is worth a line in the text log, at most one a second of cycles' time: the newest late cycle or
  /// missing feedback, and how many there were since the last line.
  std::optional<std::string> TakeMessage();

 private:
  struct Axis {
    std::uint64_t stale_cycles = 0;
    TimingHistogram response;
  };
  void AddFeedback(const CycleEntry& entry);

  std::vector<Axis> axes_;
  std::vector<std::string> names_;
  std::vector<FeedbackSource> sources_;
  Summary counts_;
  TimingHistogram wakeup_late_, receiving_, estimating_, deciding_, computing_, sending_, sent_;
  std::uint64_t cycles_ = 0;
  std::int64_t sent_at_ns_ = 0;  ///< of the cycle before, on the loop's clock
  std::int64_t now_ns_ = 0;
  std::int64_t said_ns_ = 0;
  bool said_any_ = false;
  std::array<std::uint64_t, kLateCauses> said_causes_{};
  std::uint64_t said_stale_ = 0;
  std::uint64_t stale_ = 0;
  std::uint64_t last_stale_cycles_ = 0;
  std::size_t stale_axis_ = 0;
};

}  // namespace contour
