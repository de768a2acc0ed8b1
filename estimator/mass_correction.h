#pragma once

#include <algorithm>

namespace contour {

/// By how much the axis is heavier than commissioned, learnt on line: while the axis slides, what the
/// friction model cannot explain and goes with the commanded acceleration is inertia. (Friction changes sign
/// with the direction of motion, inertia does not.) Least mean squares, normalised.
class MassCorrection {
 public:
  MassCorrection() noexcept = default;
  MassCorrection(double mass_kg, double rate) noexcept : largest_kg_(0.4 * mass_kg), rate_(rate) {}

  void Reset() noexcept { extra_kg_ = 0.0; }

  [[nodiscard]] double extra_kg() const noexcept { return extra_kg_; }

  /// `unexplained_N`: force beyond the friction model and the present correction, positive against motion.
  void Learn(double unexplained_N, double acceleration_m_s2) noexcept {
    const double square = acceleration_m_s2 * acceleration_m_s2 + kQuiet_m_s2 * kQuiet_m_s2;
    extra_kg_ =
        std::clamp(extra_kg_ + rate_ * unexplained_N * acceleration_m_s2 / square, -largest_kg_, largest_kg_);
  }

 private:
  // Slower accelerations than this teach little: a newton then stands for tens of kilograms.
  static constexpr double kQuiet_m_s2 = 0.1;

  double largest_kg_ = 0.0;
  double rate_ = 0.0;
  double extra_kg_ = 0.0;
};

}  // namespace contour
