#pragma once

#include <algorithm>
#include <cmath>

#include "control/motion_thresholds.h"
#include "core/state_keeper.h"

namespace contour {

/// What motor and table swing by against each other, of the next reading: how far that lies from where torque
/// would take a rigid axis. Torque that is told to the axis pushes the motor by no more than a share of it,
/// but a loop that stirs the swing, as one does whose table was loaded, winds the screw up by far more. A
/// swing of any frequency w goes on as x(k+1) = 2 cos(w T) x(k) - x(k-1); the screw and the motor's mass say
/// which frequencies there may be, whatever is on the table.
class SwingAhead {
 public:
  void Restart() noexcept { *this = {}; }

  /// A reading that lay so far off, one period after the one before.
  void See(double off_m, const MotionThresholds& t) noexcept {
    up_m_ = std::max(up_m_ * t.swing_ahead_kept, off_m);
    down_m_ = std::max(down_m_ * t.swing_ahead_kept, -off_m);
    older_m_ = before_m_;
    before_m_ = off_m;
  }

  /// How far beyond what a swing makes of it a reading lies that is off by so much. One that only ever grew
  /// to one side has not been seen to swing.
  [[nodiscard]] double Beyond_m(double off_m, const MotionThresholds& t) const noexcept {
    const double large_m = std::max(std::abs(before_m_), std::abs(older_m_));
    if (std::min(up_m_, down_m_) < kComesBack * large_m) return std::abs(off_m);
    const double slow_m = 2.0 * t.swing_ahead_slow * before_m_ - older_m_;
    const double fast_m = 2.0 * t.swing_ahead_fast * before_m_ - older_m_;
    const double nearest_m = std::clamp(off_m, std::min(slow_m, fast_m), std::max(slow_m, fast_m));
    return std::min(std::abs(off_m), std::abs(off_m - nearest_m));
  }

  /// The readings go to and fro about where torque would take them, by more than `least_m` to either side.
  [[nodiscard]] bool Swings(double least_m) const noexcept {
    const double large_m = std::max(std::abs(before_m_), std::abs(older_m_));
    return std::min(up_m_, down_m_) > std::max(least_m, kComesBack * large_m);
  }

  void Keep(StateKeeper& keep) noexcept { keep(before_m_, older_m_, up_m_, down_m_); }

 private:
  // Of what it is off by to one side, what it must have been off by to the other. Three readings of a swing
  // may be 1, -1/2 and -1/2 of it; it fades and grows meanwhile.
  static constexpr double kComesBack = 0.25;

  double before_m_ = 0.0, older_m_ = 0.0;
  double up_m_ = 0.0, down_m_ = 0.0;  ///< largest lately, to either side
};

}  // namespace contour
