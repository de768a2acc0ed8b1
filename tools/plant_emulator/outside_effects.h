#pragma once

#include <optional>

#include "core/visit.h"
#include "tools/plant_emulator/random.h"

// What real machines also do, and no kind of cause that diagnosis knows describes: for testing that it says
// "something is missing, no known cause fits" and gives no wrong name. The emulator alone has these.
namespace contour {

/// Friction is higher at one place, in one direction only: a damaged ball track.
struct StickSpotEffect {
  double amplitude_rel = 0.0;
  double position_mm = 0.0;
  double width_mm = 3.0;
  int direction = 1;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_rel", amplitude_rel, Range{-0.9, 20.0}, "of the friction level, at the place");
    v.Optional("position_mm", position_mm, kAny, "where");
    v.Optional("width_mm", width_mm, kPositive, "standard deviation of the bell");
    v.Optional("direction", direction, Range{-1, 1}, "1: moving up, -1: moving down");
  }
};

/// A cable chain that drags: an elastic force that gives way after millimetres and comes back the other way.
struct CableHysteresisEffect {
  double torque_Nm = 0.0;
  double travel_mm = 15.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("torque_Nm", torque_Nm, kNotNegative, "where it gives way, at the motor");
    v.Optional("travel_mm", travel_mm, kPositive, "travel over which it builds up");
  }
};

/// A torque that jumps to and fro at random: a loose connector, a brake that touches.
struct TelegraphTorqueEffect {
  double torque_Nm = 0.0;
  double dwell_s = 0.4;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("torque_Nm", torque_Nm, kNotNegative, "peak");
    v.Optional("dwell_s", dwell_s, kPositive, "mean time between two jumps");
  }
};

/// Friction falls when the axis has travelled far enough to be lubricated again, and creeps up with the way.
struct LubricationEffect {
  double change_rel = 0.0;
  double every_mm = 700.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("change_rel", change_rel, Range{0.0, 5.0}, "how much the level grows until the next drop");
    v.Optional("every_mm", every_mm, kPositive, "way between two drops");
  }
};

/// A torque in a band of speeds only, the same in both directions: an inverter that misbehaves there.
struct SpeedBandTorqueEffect {
  double torque_Nm = 0.0;
  double speed_low_rad_s = 0.0;
  double speed_high_rad_s = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("torque_Nm", torque_Nm, kAny, "inside the band");
    v.Required("speed_low_rad_s", speed_low_rad_s, kNotNegative, "of the motor");
    v.Required("speed_high_rad_s", speed_high_rad_s, kPositive, "of the motor");
  }
};

/// `effects.outside`.
struct OutsideEffectsConfig {
  std::optional<StickSpotEffect> stick_spot;
  std::optional<CableHysteresisEffect> cable_hysteresis;
  std::optional<TelegraphTorqueEffect> telegraph_torque;
  std::optional<LubricationEffect> lubrication;
  std::optional<SpeedBandTorqueEffect> speed_band_torque;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("stick_spot", stick_spot, "friction at one place in one direction");
    v.Optional("cable_hysteresis", cable_hysteresis, "a cable chain that drags");
    v.Optional("telegraph_torque", telegraph_torque, "a torque that jumps at random");
    v.Optional("lubrication", lubrication, "friction that grows with the way and drops");
    v.Optional("speed_band_torque", speed_band_torque, "a torque in a band of speeds");
  }
};

namespace plant {

/// Their state while the axis moves.
class OutsideEffects {
 public:
  OutsideEffects(const OutsideEffectsConfig& config, double radius_m_rad) noexcept;

  /// Moves on by a step with the table where it is.
  void Advance(double step_s, double table_m, double table_m_s) noexcept;
  /// Added to the factor 1 of the friction levels.
  [[nodiscard]] double Level(double table_m, double table_m_s) const noexcept;
  /// Accelerates towards positive position, at the table.
  [[nodiscard]] double Force_N(double table_m_s) const noexcept;

 private:
  OutsideEffectsConfig c_;
  double radius_m_rad_;
  Random random_;
  double cable_N_ = 0.0;
  double last_m_ = 0.0;
  bool has_last_ = false;
  double way_m_ = 0.0;
  double telegraph_ = 1.0;
  double until_jump_s_ = 0.0;
};

}  // namespace plant
}  // namespace contour
