#pragma once

#include <cmath>
#include <cstdint>
#include <mutex>

#include "core/cycle_record.h"

namespace contour {

/// What has come of a program so far, as the cycle saw it.
struct TallyOfProgram {
  std::uint32_t program_id = 0;
  std::uint64_t cycles = 0;  ///< that it ran, pauses among them
  double contour_error_peak_m = 0.0;
  double contour_error_rms_m = 0.0;  ///< both at the encoders, of the cycles in which it moved
};

/// Follows the program that runs. One thread consumes, any thread reads.
class ProgramTally {
 public:
  void Consume(const CycleRecord& record) {
    if (record.state != MachineState::kRunning) return;
    const std::lock_guard lock(mutex_);
    if (record.program_id != tally_.program_id) {
      tally_ = {record.program_id, 0, 0.0, 0.0};
      moving_ = 0;
      sum_m2_ = 0.0;
    }
    ++tally_.cycles;
    if (record.pace == 0.0) return;
    const double error_m = std::abs(record.contour_error_m);
    if (!std::isfinite(error_m)) return;
    ++moving_;
    sum_m2_ += error_m * error_m;
    tally_.contour_error_peak_m = std::fmax(tally_.contour_error_peak_m, error_m);
    tally_.contour_error_rms_m = std::sqrt(sum_m2_ / static_cast<double>(moving_));
  }
  [[nodiscard]] TallyOfProgram tally() const {
    const std::lock_guard lock(mutex_);
    return tally_;
  }

 private:
  mutable std::mutex mutex_;
  TallyOfProgram tally_;
  std::uint64_t moving_ = 0;
  double sum_m2_ = 0.0;
};

}  // namespace contour
