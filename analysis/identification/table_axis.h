#pragma once

#include <array>
#include <cstddef>

#include "analysis/axis_model/axis_model.h"
#include "analysis/axis_model/stated_axis.h"
#include "config/model_config.h"

namespace contour::identify {

/// How a friction level varies about its average over the segment that was travelled: Legendre polynomials of
/// the place, and harmonics of the motor's turn for each direction. The polynomials have no mean over the
/// segment and the harmonics none over a turn, so the levels themselves are the averages.
struct LevelVariation {
  static constexpr std::size_t kDegrees = 3;
  static constexpr std::size_t kHarmonics = 2;
  double low_m = 0.0, high_m = 0.0;  ///< the segment
  std::array<double, kDegrees> place{};
  std::array<double, 2 * kHarmonics> turn_plus{};  ///< cos, sin of each harmonic
  std::array<double, 2 * kHarmonics> turn_minus{};
};

/// A torque of the motor that goes with its angle and not with what is commanded: cogging. Seen at the table,
/// positive accelerates towards positive position.
struct MotorWave {
  double order = 0.0;  ///< per turn; 0: none
  double cosine_N = 0.0, sine_N = 0.0;
};
inline constexpr std::size_t kMostWaves = 3;

/// A part of the table that swings on a spring along the axis.
struct SideMass {
  double share = 0.0;  ///< of the table's mass; 0: none
  double frequency_Hz = 0.0, damping_ratio = 0.02;
};

/// What the loop that a drive closes answers to a step of the offset that it is sent, within the same period:
/// a ramp against it, since the motor gathers speed, and what is not so simple.
struct DriveAnswer {
  double gain = 0.0;  ///< N of the ramp after a period for each N of the step: velocity gain times period
  double delay_s = 0.2e-3;
  /// What is quicker: of the period's mean for each N of the step at the end of the period, at its beginning,
  /// and of those before.
  std::array<double, 4> step{};
};

/// An axis as identification sees it: the axis model of diagnosis with the table's travel as its coordinate
/// (q in m, u in N, inertias in kg; the motor is R theta with the mass Jm / R^2), and what only
/// identification asks for. One mass (not two_inertia): motor_inertia is everything.
struct TableAxis : diagnosis::AxisModel {
  double radius_m_rad = 0.0;  ///< table travel per unit of the recorded position
  double turn_m = 0.0;        ///< travel of a motor turn; 0: there is none to look for
  LevelVariation variation;
  /// Share of all friction that acts on the motor; where friction_on_load.
  double motor_friction_share = 0.0;
  DriveAnswer answer;
  std::array<MotorWave, kMostWaves> cogging{};
  SideMass side;

  [[nodiscard]] double mass_kg() const { return motor_inertia + load_inertia; }
};

/// Force of the motor's waves at a place of the motor.
double Cogging_N(const TableAxis& axis, double motor_m);

/// Rotary axes without a lead are taken as having 1 m/rad: then kg is kg m^2 and N is Nm.
TableAxis FromStated(const diagnosis::StatedAxis& stated);

/// Puts the identified values into `model`, in its own units and on its own side (acts_on).
void IntoConfig(const TableAxis& axis, ModelConfig& model);

}  // namespace contour::identify
