#pragma once

#include <array>
#include <cstddef>

#include "analysis/axis_model/stated_axis.h"
#include "config/model_config.h"

// One axis as identification sees it: SI at the table (m, N, kg), the motor as R theta with mass Jm / R^2.
namespace contour::identify {

/// How a friction level varies about its average over the stretch that was travelled: Legendre polynomials of
/// the place, and harmonics of the motor's turn for each direction. The polynomials have no mean over the
/// stretch and the harmonics none over a turn, so the levels themselves are the averages.
struct LevelVariation {
  static constexpr std::size_t kDegrees = 3;
  static constexpr std::size_t kHarmonics = 2;
  double low_m = 0.0, high_m = 0.0;  ///< the stretch
  std::array<double, kDegrees> place{};
  std::array<double, 2 * kHarmonics> turn_plus{};  ///< cos, sin of each harmonic
  std::array<double, 2 * kHarmonics> turn_minus{};
};

/// Two masses joined by the screw, LuGre friction on the table:
///   m v_m' = F - S + offset, Mt v_t' = S - Fn - sigma2 v_t, S = K (x_m - x_t) + c (v_m - v_t),
///   Fn = sigma0 z + sigma1(v) z', z' = v - sigma0 |v| z / g, g = Fc + (Fs - Fc) exp(-(|v| / vs)^n),
///   sigma1(v) = sigma1 exp(-(v / vd)^2).
struct AxisModel {
  double radius_m_rad = 0.0;  ///< table travel per unit of the recorded position
  double turn_m = 0.0;        ///< travel of a motor turn; 0: there is none to look for
  /// One mass: motor_mass_kg is everything, table_mass_kg 0, there is no screw.
  bool rigid = false;
  bool friction_at_motor = false;  ///< else on the table; rigid: the same
  double motor_mass_kg = 0.0;
  double table_mass_kg = 0.0;
  double stiffness_N_m = 0.0;
  double damping_Ns_m = 0.0;
  Friction friction;
  LevelVariation variation;
  double offset_N = 0.0;
  double delay_s = 0.0;  ///< from a row's sample to the beginning of its command
  double lag_s = 0.0;    ///< first-order current loop

  [[nodiscard]] double mass_kg() const { return motor_mass_kg + table_mass_kg; }
};

/// Rotary axes without a lead are taken as having 1 m/rad: then kg is kg m^2 and N is Nm.
AxisModel FromStated(const diagnosis::StatedAxis& stated);

/// Puts the identified values into `model`, in its own units and on its own side (acts_on).
void IntoConfig(const AxisModel& axis, ModelConfig& model);

}  // namespace contour::identify
