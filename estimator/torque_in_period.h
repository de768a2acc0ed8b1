#pragma once

#include "core/state_keeper.h"
#include "estimator/drive_lag.h"

namespace contour {

/// Mean force of a drive over the period that has passed, from what it reported at both ends. Its own loops
/// change the torque evenly; the offset that we send changes at the beginning of the period at once, and what
/// the current's lag makes of that the two ends do not show. Taking the mean of the ends for all of it would
/// be 0.3 of a period late, and call what a reversal's torque changes in that time a force on the table.
class TorqueInPeriod {
 public:
  TorqueInPeriod() noexcept = default;
  TorqueInPeriod(double period_s, double lag_s) noexcept : offset_(period_s, lag_s) {}

  /// `offset_N`: sent, and in force over the period.
  double Mean_N(double before_N, double now_N, double offset_N) noexcept {
    const double from_N = offset_.force_N();
    const double mean_N = offset_.Step(offset_N)[0];
    return 0.5 * (before_N + now_N) + (mean_N - 0.5 * (from_N + offset_.force_N()));
  }

  void Keep(StateKeeper& keep) noexcept { keep(offset_); }

 private:
  DriveLag<1> offset_;
};

}  // namespace contour
