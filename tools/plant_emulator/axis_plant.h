#pragma once

#include <cstdint>
#include <optional>

#include "tools/plant_emulator/axis_parameters.h"
#include "tools/plant_emulator/outside_effects.h"
#include "tools/plant_emulator/place_friction.h"
#include "tools/plant_emulator/side_modes.h"

namespace contour::plant {

/// The mechanics of one axis: motor and table, two inertias joined by the screw (MODEL eqs. 1-3 with the
/// screw's own damping), friction on the table. Motor angle as R theta, motor inertia as Jm / R^2, so all is
/// in metres and newtons:
///   m v_m' = T / R - S - ...,   Mt v_t' = S - F(v_t) + ...,   S = K (x_m - x_t) + c (v_m - v_t).
/// A share of the friction may act on the motor instead, and a share of the table's mass swing on springs.
/// A step solves the implicit midpoint rule: energy of the spring is kept, nothing is too stiff for it.
class AxisPlant {
 public:
  /// Throws std::invalid_argument.
  explicit AxisPlant(const AxisParameters& parameters);

  /// Advances by one sub-step, at most MaxStep_s(), under a mean motor torque.
  void Step(double step_s, double torque_Nm) noexcept;

  /// Longest sub-step that keeps the screw's mode and the presliding mode within 0.2 % of their frequencies.
  [[nodiscard]] double MaxStep_s() const noexcept { return max_step_s_; }

  /// Force of another axis's acceleration, held until set again.
  void SetCouplingForce_N(double force_N) noexcept { coupling_N_ = force_N; }

  [[nodiscard]] double motor_position_m() const noexcept { return motor_m_; }
  [[nodiscard]] double motor_velocity_m_s() const noexcept { return motor_m_s_; }
  [[nodiscard]] double motor_angle_rad() const noexcept { return motor_m_ / p_.radius_m_rad; }
  /// The lead's error included.
  [[nodiscard]] double table_position_m() const noexcept;
  [[nodiscard]] double table_velocity_m_s() const noexcept { return table_m_s_; }
  [[nodiscard]] double table_acceleration_m_s2() const noexcept { return table_m_s2_; }
  /// Of the whole axis: on the table, and on the motor as seen at the table.
  [[nodiscard]] double friction_N() const noexcept;
  [[nodiscard]] double elastic_N() const noexcept;
  [[nodiscard]] double temperature_degC() const noexcept { return temperature_degC_; }
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  /// The motor's torque at this instant for what the current loop gives: torque constant, ripple, saturation.
  [[nodiscard]] double DeliveredTorque_Nm(double torque_Nm) const noexcept;
  /// Kinetic and elastic energy (screw, side modes), J.
  [[nodiscard]] double energy_J() const noexcept;

  /// For tests: puts the axis into a state; side masses rest on the table.
  void SetState(double motor_m, double motor_m_s, double table_m, double table_m_s) noexcept;

 private:
  struct Contact {
    double offset_m = 0.0;  ///< wind-up at which the force is zero
    double stiffness_N_m = 0.0;
    double damping_Ns_m = 0.0;
  };
  [[nodiscard]] Contact ScrewContact(double expected_windup_m) const noexcept;
  [[nodiscard]] FrictionScale Scale() const noexcept;
  [[nodiscard]] double MotorForce_N(double torque_Nm) const noexcept;
  [[nodiscard]] double TableForce_N() const noexcept;
  [[nodiscard]] double CounterbalanceForce_N() const noexcept;
  [[nodiscard]] double ExtraFriction_N(double velocity_m_s) const noexcept;
  void UpdateSlowThings(double step_s) noexcept;
  void ChooseStep() noexcept;

  AxisParameters p_;
  PlaceFriction friction_;                       ///< on the table
  std::optional<PlaceFriction> motor_friction_;  ///< before the screw
  SideModes side_modes_;
  std::optional<OutsideEffects> outside_;
  double motor_mass_kg_ = 0.0;
  double table_mass_kg_ = 0.0;  ///< what does not swing, a counterbalance's mass included
  double max_step_s_ = 0.0;

  double time_s_ = 0.0;
  double motor_m_ = 0.0;
  double motor_m_s_ = 0.0;
  double motor_m_s2_ = 0.0;
  double table_m_ = 0.0;
  double table_m_s_ = 0.0;
  double table_m_s2_ = 0.0;
  double temperature_degC_ = 20.0;
  double coupling_N_ = 0.0;
  double slow_s_ = 0.0;  ///< time since the slow factors were last worked out
  double heat_J_ = 0.0;
  double slow_factor_ = 1.0;     ///< drift and temperature on the levels
  double viscous_factor_ = 1.0;  ///< temperature on sigma2
};

}  // namespace contour::plant
