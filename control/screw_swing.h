#pragma once

#include <algorithm>
#include <cmath>

#include "control/motion_thresholds.h"
#include "core/state_keeper.h"

namespace contour {

/// What motor and table swing by against each other, told from the motor alone. To a balance with one mass
/// that swing is a force which nothing explains: at the mode it is as many times the torque that stirs it as
/// the table has motors' masses and the screw little damping, and between the antiresonance and the mode the
/// motor goes against the torque. A low-pass below the mode leaves a share of it.
///
/// The same swing shows in what the low-pass takes out, and any oscillation of the lowest mode or above
/// leaves no more in it than a known share of that. What no torque has stirred is no swing of the screw.
class ScrewSwing {
 public:
  /// The axis is enabled.
  void Restart() noexcept { *this = {}; }

  /// After the low-passes: force that nothing explains and torque, each less its low-passed value.
  void See(double unexplained_N, double torque_N, const MotionThresholds& t) noexcept {
    // A reading that lies by a jump is no swing that grew from what stirred it.
    const double swing_N = std::min(std::abs(unexplained_N), t.swing_gain * stirred_N_);
    square_N2_ += t.swing_filter * (swing_N * swing_N - square_N2_);
    stirred_N_ = std::max(stirred_N_ * t.peak_decay, std::abs(torque_N));
  }

  /// Of the low-passed force, what the swing may make.
  [[nodiscard]] double Left_N(const MotionThresholds& t) const noexcept {
    return t.swing_left * std::min(std::sqrt(2.0 * square_N2_), t.swing_gain * stirred_N_);
  }

  void Keep(StateKeeper& keep) noexcept { keep(square_N2_, stirred_N_); }

 private:
  double square_N2_ = 0.0;  ///< mean, over half a swing
  double stirred_N_ = 0.0;  ///< largest lately, fading as the screw's swing does
};

}  // namespace contour
