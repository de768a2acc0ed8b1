#pragma once

#include <algorithm>
#include <cmath>

#include "estimator/filter_setup.h"
#include "estimator/share_of_period.h"

namespace contour {

/// By how much the axis is more viscous than commissioned, learnt on line: while the axis slides, what the
/// friction model cannot explain and grows with the speed is viscous. Normalised least mean squares on the
/// deviations of both from their means: at one speed viscous and Coulomb friction are the same, and a force
/// from outside does not go with the speed.
///
/// How small a change of speed still teaches depends on how much Coulomb friction there is for it to be
/// mistaken for. Without any, viscous friction is all there is: it is learnt from the speed itself, from slow
/// motions too, and faster.
class ViscousCorrection {
 public:
  struct Tuning {
    double viscous_Ns_m = 0.0;    ///< as commissioned
    double viscous_rate = 0.001;  ///< share of the error taken over per millisecond
    double period_s = 1e-3;
    AxisScale scale{};
  };

  ViscousCorrection() noexcept = default;
  explicit ViscousCorrection(const Tuning& tuning) noexcept
      : tuning_(tuning),
        rate_(ShareOfPeriod(tuning.viscous_rate, tuning.period_s)),
        mean_share_(ShareOfPeriod(kMeanShare, tuning.period_s)),
        quiet2_(kQuiet * tuning.scale.acceleration_m_s2 * kQuiet * tuning.scale.acceleration_m_s2),
        slow_m_s_(kSlow * tuning.scale.speed_m_s),
        room_Ns_m_(kLeastRoom * tuning.scale.friction_N / tuning.scale.speed_m_s) {}

  void Reset() noexcept { extra_Ns_m_ = mean_speed_m_s_ = mean_along_N_ = 0.0; }

  /// The axis rests: what has come to its upper bound is no answer. The lower one is no friction at all.
  void Rest() noexcept {
    if (extra_Ns_m_ >= kAtBound * (2.0 * tuning_.viscous_Ns_m + room_Ns_m_)) Reset();
  }

  [[nodiscard]] double extra_Ns_m() const noexcept { return extra_Ns_m_; }

  /// `unexplained_N`: force beyond the friction model and the present correction, positive against positive
  /// motion. `level_share`: the friction level in this direction over the commissioned one.
  void Learn(double unexplained_N, double velocity_m_s, double acceleration_m_s2,
             double level_share = 1.0) noexcept {
    const double a2 = acceleration_m_s2 * acceleration_m_s2;
    const double slow_m_s = slow_m_s_ * std::clamp(2.0 * level_share, kLeastSlow, 1.0);
    const double speed_m_s = std::abs(velocity_m_s);
    const double along_N = velocity_m_s >= 0.0 ? unexplained_N : -unexplained_N;
    const bool none = level_share < kNoLevel;
    if (mean_speed_m_s_ == 0.0) {
      mean_speed_m_s_ = speed_m_s;
      mean_along_N_ = along_N;
    }
    const double x = none ? speed_m_s : speed_m_s - mean_speed_m_s_;
    const double y = none ? along_N : along_N - mean_along_N_;
    const double per_v = x / (x * x + slow_m_s * slow_m_s);
    mean_speed_m_s_ += mean_share_ * (speed_m_s - mean_speed_m_s_);
    mean_along_N_ += mean_share_ * (along_N - mean_along_N_);
    // Where the axis accelerates, a wrong mass would be taken for it.
    const double haste = none ? 1.0 + (kHaste - 1.0) * quiet2_ / (a2 + quiet2_) : 1.0;
    // Never below no viscous friction at all.
    extra_Ns_m_ = std::clamp(extra_Ns_m_ + haste * rate_ * y * per_v, -tuning_.viscous_Ns_m,
                             2.0 * tuning_.viscous_Ns_m + room_Ns_m_);
  }

 private:
  static constexpr double kMeanShare = 2e-3;  // per millisecond
  // Slower accelerations, in Fc / m, and velocities, in Stribeck velocities, teach little: a newton then
  // stands for tens of kilograms.
  static constexpr double kQuiet = 0.229;
  static constexpr double kSlow = 4.9;
  static constexpr double kLeastSlow = 0.02;  // of kSlow
  // A level below this share of the commissioned one is none.
  static constexpr double kNoLevel = 0.01;
  static constexpr double kHaste = 5.0;
  static constexpr double kLeastRoom = 0.00526;  // of Fc per Stribeck velocity

  Tuning tuning_;
  double rate_ = 0.0;  // shares per period
  double mean_share_ = 0.0;
  double quiet2_ = 0.01;
  double slow_m_s_ = 10e-3;
  double room_Ns_m_ = 100.0;
  double extra_Ns_m_ = 0.0;
  double mean_speed_m_s_ = 0.0;
  double mean_along_N_ = 0.0;
};

}  // namespace contour
