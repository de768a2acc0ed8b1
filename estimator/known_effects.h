#pragma once

#include <vector>

#include "core/mechanics.h"
#include "estimator/extension_config.h"

namespace contour {

/// What the extensions of a model say about the axis at a place, speed and temperature. Table units. Nothing
/// allocates after construction; without extensions everything is neutral.
class KnownEffects {
 public:
  KnownEffects() = default;
  /// Throws std::invalid_argument when a table is not one: lengths that differ, positions that do not ascend.
  KnownEffects(const ExtensionsConfig& config, const Mechanics& mechanics, double viscous_Ns_m);

  /// Without extensions: no force, no lead, nothing viscous, factor 1.
  [[nodiscard]] bool neutral() const noexcept { return neutral_; }
  /// Forces beside the command's, positive towards positive position: on the motor, before the screw; on the
  /// table, behind it, where they wind the screw up as friction does; both.
  [[nodiscard]] double MotorForce_N(double position_m) const noexcept;
  [[nodiscard]] double TableForce_N(double position_m) const noexcept { return spring_N_.At(position_m); }
  [[nodiscard]] double Force_N(double position_m) const noexcept {
    return MotorForce_N(position_m) + TableForce_N(position_m);
  }
  /// Of those on the motor, what is the same everywhere.
  [[nodiscard]] double Constant_N() const noexcept { return constant_N_; }
  /// Factor of the friction level.
  [[nodiscard]] double LevelFactor(double position_m) const noexcept;
  /// Friction beside bristle and sigma2 v, with the sign of the velocity. NaN means an unknown temperature.
  [[nodiscard]] double Viscous_N(double velocity_m_s, double temperature_degC) const noexcept;
  /// By how much the motor has to lead, R theta - p, for the table to stand at `position_m`.
  [[nodiscard]] double Lead_m(double position_m) const noexcept;

 private:
  /// A curve of straight lines; constant beyond its ends.
  struct Table {
    std::vector<double> x, y;
    [[nodiscard]] double At(double at) const noexcept;
  };
  struct Wave {
    double amplitude = 0.0;
    double turns_1_m = 0.0;
    double phase_turns = 0.0;
    [[nodiscard]] double At(double position_m) const noexcept;
  };
  using Waves = std::vector<Wave>;
  /// Of the speed.
  struct Curve {
    double force_N = 0.0, max_speed_m_s = 1.0, exponent = 2.0, knee = 0.0;
    [[nodiscard]] double At(double velocity_m_s) const noexcept;
  };
  static double Sum(const Waves& waves, double position_m) noexcept;
  static Table MakeTable(const char* kind, const std::vector<double>& position_mm,
                         const std::vector<double>& values, double unit);

  bool neutral_ = true;
  double constant_N_ = 0.0;
  Waves cogging_;
  Table spring_N_;
  Waves ripple_, ball_;
  Table friction_rel_;
  std::vector<Curve> viscous_;
  double viscous_asymmetry_Ns_m_ = 0.0;  ///< more upwards, less downwards
  double viscous_rate_Ns_m_K_ = 0.0, reference_degC_ = 20.0;
  Table pitch_m_;
  Waves wobble_;  ///< m
};

}  // namespace contour
