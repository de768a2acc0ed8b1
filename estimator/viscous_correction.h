#pragma once

#include <algorithm>
#include <cmath>

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
  };

  ViscousCorrection() noexcept = default;
  explicit ViscousCorrection(const Tuning& tuning) noexcept
      : tuning_(tuning),
        rate_(ShareOfPeriod(tuning.viscous_rate, tuning.period_s)),
        mean_share_(ShareOfPeriod(kMeanShare, tuning.period_s)) {}

  void Reset() noexcept { extra_Ns_m_ = mean_speed_m_s_ = mean_along_N_ = 0.0; }

  [[nodiscard]] double extra_Ns_m() const noexcept { return extra_Ns_m_; }

  /// `unexplained_N`: force beyond the friction model and the present correction, positive against positive
  /// motion. `level_share`: the friction level in this direction over the commissioned one.
  void Learn(double unexplained_N, double velocity_m_s, double acceleration_m_s2,
             double level_share = 1.0) noexcept {
    const double a2 = acceleration_m_s2 * acceleration_m_s2;
    const double quiet2 = kQuiet_m_s2 * kQuiet_m_s2;
    const double slow_m_s = kSlow_m_s * std::clamp(2.0 * level_share, kLeastSlow, 1.0);
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
    const double haste = none ? 1.0 + (kHaste - 1.0) * quiet2 / (a2 + quiet2) : 1.0;
    // Never below no viscous friction at all.
    extra_Ns_m_ = std::clamp(extra_Ns_m_ + haste * rate_ * y * per_v, -tuning_.viscous_Ns_m,
                             2.0 * tuning_.viscous_Ns_m + kLeastRoom_Ns_m);
  }

 private:
  static constexpr double kMeanShare = 2e-3;  // per millisecond
  // Slower accelerations and velocities than these teach little: a newton then stands for tens of kilograms.
  static constexpr double kQuiet_m_s2 = 0.1;
  static constexpr double kSlow_m_s = 10e-3;
  static constexpr double kLeastSlow = 0.02;  // of kSlow_m_s
  // A level below this share of the commissioned one is none.
  static constexpr double kNoLevel = 0.01;
  static constexpr double kHaste = 5.0;
  static constexpr double kLeastRoom_Ns_m = 100.0;

  Tuning tuning_;
  double rate_ = 0.0;  // shares per period
  double mean_share_ = 0.0;
  double extra_Ns_m_ = 0.0;
  double mean_speed_m_s_ = 0.0;
  double mean_along_N_ = 0.0;
};

}  // namespace contour
