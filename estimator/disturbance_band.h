#pragma once

#include <algorithm>
#include <cmath>

namespace contour {

/// By how much a disturbance may be off as a force from outside. Whatever friction is believed to be is off
/// by something, and that shows as a disturbance, too; nothing on the axis tells the two apart. So beside the
/// variance of the estimate counts what the disturbance has lately been in motion, in the mean square.
class DisturbanceBand {
 public:
  DisturbanceBand() noexcept = default;
  /// `std_N`: of friction as commissioned.
  DisturbanceBand(double std_N, double period_s) noexcept
      : commissioned_N2_(std_N * std_N), most_(std::max(kMemory_s / period_s, 1.0)) {
    Reset();
  }

  void Reset() noexcept {
    mean_N2_ = commissioned_N2_;
    samples_ = 1.0;  // for as much it counts
  }
  /// A sample of an axis that moves.
  void Step(double disturbance_N) noexcept {
    samples_ = std::min(samples_ + 1.0, most_);
    mean_N2_ += (disturbance_N * disturbance_N - mean_N2_) / samples_;
  }
  [[nodiscard]] double MeanSquare_N2() const noexcept { return mean_N2_; }
  /// One standard deviation, where the estimate itself has this variance.
  [[nodiscard]] double Std_N(double variance_N2) const noexcept { return std::sqrt(mean_N2_ + variance_N2); }

 private:
  static constexpr double kMemory_s = 0.5;  // of motion

  double commissioned_N2_ = 0.0, most_ = 1.0;
  double mean_N2_ = 0.0, samples_ = 1.0;
};

}  // namespace contour
