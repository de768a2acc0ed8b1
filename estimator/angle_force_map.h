#pragma once

#include <array>
#include <cstddef>

namespace contour {

/// Force on the motor that belongs to the angle of the screw whatever the direction: cogging, torque ripple.
/// Learnt on line while the axis slides, place by place over one turn: how many teeth there are need not be
/// known, and one turn is enough to know them all.
class AngleForceMap {
 public:
  struct Tuning {
    double lead_m = 5e-3;
    double noise_N = 1.0;  ///< of what is learnt from in a cycle, by the encoder
    double rate =
        0.0;  ///< share of the error learnt at least per visit of a millisecond; 0: nothing is learnt
    double period_s = 1e-3;
    double level_N = 40.0;  ///< Coulomb friction of the axis
    double vs_m_s = 2e-3;   ///< its Stribeck velocity
    double mass_kg = 90.0;
  };

  AngleForceMap() noexcept = default;
  explicit AngleForceMap(const Tuning& tuning) noexcept;

  void Reset() noexcept;

  [[nodiscard]] bool in_use() const noexcept { return use_ > 0.0; }
  /// Positive towards positive position; as much of the map as explains something.
  [[nodiscard]] double At_N(double position_m, double velocity_m_s) const noexcept;

  /// `missing_N`: force that the axis was driven with beyond what is known, the map included.
  void Learn(double position_m, double velocity_m_s, double acceleration_m_s2, double missing_N) noexcept;

 private:
  static constexpr std::size_t kBins = 128;
  struct Place {
    std::size_t bin, next;
    double share;  ///< of the next bin
  };
  [[nodiscard]] Place PlaceOf(double position_m) const noexcept;
  [[nodiscard]] double Stored_N(const Place& place) const noexcept;
  void LearnAt(std::size_t bin, double weight, double error_N) noexcept;

  double per_turn_1_m_ = 200.0;
  double largest_N_ = 50.0;
  double ripple_N2_ = 15.0;
  double slow_m_s_ = 4e-3, fast_m_s_ = 0.15;
  double quiet_m_s2_ = 1.0;
  double first_visits_ = 1.0;
  double rate_ = 0.0;
  double visit_ = 1.0;  // of a cycle, in milliseconds
  double mean_share_ = 0.0;
  double power_share_ = 0.0;
  double mean_N_ = 0.0;
  double without_N2_ = 0.0;  // mean squares of what is missing without the map and with it
  double with_N2_ = 0.0;
  double use_ = 0.0;
  std::size_t places_ = 0;  ///< that have been visited
  std::array<double, kBins> force_N_{};
  std::array<double, kBins> visits_{};
};

}  // namespace contour
