#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "control/motion_thresholds.h"
#include "core/state_keeper.h"

namespace contour {

/// A reading of an axis whose drive closes the loop.
struct DriveReading {
  double reference_m = 0.0;
  std::uint32_t same_periods = 0;    ///< that the reading has been exactly the same
  std::uint32_t waited_periods = 1;  ///< since the reading before
  double force_N = 0.0;              ///< the drive's report (0x6077), low-passed
  double swing_N = 0.0;              ///< the report, less that
  double noise_N = 0.0;              ///< by which it changes without a push, see ReportTurns
};

/// Whether a drive's own loop pushes against a reading that stands. At rest nothing but readings changes its
/// torque, so one that goes on changing under one and the same reading does. A report that is filtered goes
/// on for a while, too, by what it lagged behind when the reading last changed; and what it swings by, to and
/// fro, is its noise.
class DrivePush {
 public:
  /// The axis is enabled.
  void Restart(double reference_m) noexcept {
    *this = {};
    reference_m_ = reference_m;
  }

  [[nodiscard]] bool Seen(const DriveReading& r, const MotionThresholds& t, double period_s) noexcept {
    if (r.same_periods == 0 || r.reference_m != reference_m_) {
      reference_m_ = r.reference_m;
      periods_ = 0;
      tail_N_ = std::abs(r.swing_N);
      pushed_ = 0;
      return false;
    }
    periods_ = std::min(periods_ + r.waited_periods, t.rest_periods);
    return Large(r, t, period_s) || Small(r, t);
  }

  void Keep(StateKeeper& keep) noexcept {
    keep(reference_m_, periods_, tail_N_, least_N_, most_N_, pushed_, swing_N_, small_least_N_,
         small_most_N_);
  }

 private:
  // After which a report that lags behind is off its own mean.
  static constexpr std::uint32_t kShowsTail_periods = static_cast<std::uint32_t>(kChatter_periods);

  /// Since the report has settled, by more than it may be wrong by and inertia takes up.
  bool Large(const DriveReading& r, const MotionThresholds& t, double period_s) noexcept {
    tail_N_ *= t.tail_decay;
    if (r.same_periods <= kShowsTail_periods) tail_N_ = std::max(tail_N_, std::abs(r.swing_N));
    if (periods_ <= t.begin_periods || tail_N_ > t.tail_N) least_N_ = most_N_ = r.force_N;
    least_N_ = std::min(least_N_, r.force_N);
    most_N_ = std::max(most_N_, r.force_N);
    const double pushed_N = most_N_ - least_N_ - t.rest_force_N - r.noise_N;
    const bool large = pushed_N > 0.0 && pushed_N > t.Inertial_N(t.frozen, periods_ * period_s);
    pushed_ = large ? pushed_ + 1 : 0;
    return pushed_ >= MotionThresholds::kPushReports;
  }

  /// Lately, by more than presliding takes up and the report swings by.
  bool Small(const DriveReading& r, const MotionThresholds& t) noexcept {
    if (periods_ < t.rest_periods) {
      small_least_N_ = small_most_N_ = r.force_N;
      swing_N_ = 0.0;
      return false;
    }
    swing_N_ = std::max(swing_N_ * t.push_kept, std::abs(r.swing_N));
    small_least_N_ += t.push_fade * (r.force_N - small_least_N_);
    small_most_N_ += t.push_fade * (r.force_N - small_most_N_);
    small_least_N_ = std::min(small_least_N_, r.force_N);
    small_most_N_ = std::max(small_most_N_, r.force_N);
    return small_most_N_ - small_least_N_ > t.frozen.force_N + t.swing * swing_N_;
  }

  double reference_m_ = 0.0;
  std::uint32_t periods_ = 0;  ///< that reference and reading have stood still
  double tail_N_ = 0.0;        ///< that the report lagged behind by when the reading last changed, fading
  double least_N_ = 0.0, most_N_ = 0.0;              ///< of the force, since then
  std::uint32_t pushed_ = 0;                         ///< readings in a row
  double swing_N_ = 0.0;                             ///< largest lately, fading
  double small_least_N_ = 0.0, small_most_N_ = 0.0;  ///< of the force lately, fading
};

}  // namespace contour
