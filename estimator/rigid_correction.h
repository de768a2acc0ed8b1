#pragma once

#include <algorithm>

namespace contour {

/// By how much the axis is heavier and more viscous than commissioned, learnt on line: while the axis slides,
/// what the friction model cannot explain and goes with the commanded acceleration is inertia, what goes with
/// the commanded velocity is viscous. (Coulomb friction only changes sign with the direction of motion.)
/// Least mean squares, normalised.
///
/// How slow a motion still teaches viscous friction depends on how much Coulomb friction there is for it to
/// be mistaken for. Without any, viscous friction is all there is: it is learnt from slow motions too, and
/// faster.
class RigidCorrection {
 public:
  struct Tuning {
    double mass_kg = 0.0;       ///< as commissioned
    double viscous_Ns_m = 0.0;  ///< as commissioned
    double mass_rate = 0.001;   ///< share of the error taken over per cycle
    double viscous_rate = 0.001;
  };

  RigidCorrection() noexcept = default;
  explicit RigidCorrection(const Tuning& tuning) noexcept : tuning_(tuning) {}

  void Reset() noexcept { extra_kg_ = extra_Ns_m_ = 0.0; }

  [[nodiscard]] double extra_kg() const noexcept { return extra_kg_; }
  [[nodiscard]] double extra_Ns_m() const noexcept { return extra_Ns_m_; }

  /// `unexplained_N`: force beyond the friction model and the present correction, positive against positive
  /// motion. `level_share`: the friction level in this direction over the commissioned one.
  void Learn(double unexplained_N, double velocity_m_s, double acceleration_m_s2,
             double level_share = 1.0) noexcept {
    const double a2 = acceleration_m_s2 * acceleration_m_s2;
    const double quiet2 = kQuiet_m_s2 * kQuiet_m_s2;
    const double per_a = acceleration_m_s2 / (a2 + quiet2);
    const double slow_m_s = kSlow_m_s * std::clamp(2.0 * level_share, kLeastSlow, 1.0);
    const double per_v = velocity_m_s / (velocity_m_s * velocity_m_s + slow_m_s * slow_m_s);
    // Where the axis accelerates, a wrong mass would be taken for it.
    const double haste = level_share < kNoLevel ? 1.0 + (kHaste - 1.0) * quiet2 / (a2 + quiet2) : 1.0;
    const double most_kg = kMost * tuning_.mass_kg;
    extra_kg_ = std::clamp(extra_kg_ + tuning_.mass_rate * unexplained_N * per_a, -most_kg, most_kg);
    // Never below no viscous friction at all.
    extra_Ns_m_ = std::clamp(extra_Ns_m_ + haste * tuning_.viscous_rate * unexplained_N * per_v,
                             -tuning_.viscous_Ns_m, 2.0 * tuning_.viscous_Ns_m + kLeastRoom_Ns_m);
  }

 private:
  // Slower accelerations and velocities than these teach little: a newton then stands for tens of kilograms.
  static constexpr double kQuiet_m_s2 = 0.1;
  static constexpr double kSlow_m_s = 10e-3;
  static constexpr double kLeastSlow = 0.02;  // of kSlow_m_s
  // A level below this share of the commissioned one is none.
  static constexpr double kNoLevel = 0.01;
  static constexpr double kHaste = 5.0;
  static constexpr double kMost = 0.4;
  static constexpr double kLeastRoom_Ns_m = 100.0;

  Tuning tuning_;
  double extra_kg_ = 0.0;
  double extra_Ns_m_ = 0.0;
};

}  // namespace contour
