#pragma once

#include <optional>
#include <variant>

#include "tools/plant_emulator/axis_parameters.h"
#include "tools/plant_emulator/lugre_friction.h"
#include "tools/plant_emulator/maxwell_slip_friction.h"

namespace contour::plant {

/// Friction of one place of an axis, guides and nut behind the screw or bearings before it: that share of the
/// axis's friction, by the axis's law, and the second presliding element where there is one.
class PlaceFriction {
 public:
  PlaceFriction(const AxisParameters& parameters, double share);

  void SetElastic_N(double force_N) noexcept;
  /// Force over one step as a line in the step's mean velocity; see FrictionLine.
  FrictionLine Line(double expected_m_s, double step_s, const FrictionScale& scale) noexcept;
  /// Moves the bristles over the step that Line() prepared.
  void Commit(double velocity_m_s) noexcept;
  [[nodiscard]] double Force_N(double velocity_m_s, const FrictionScale& scale) const noexcept;
  [[nodiscard]] double Elastic_N() const noexcept;

 private:
  std::variant<LugreFriction, MaxwellSlipFriction> main_;
  std::optional<LugreFriction> second_;
};

}  // namespace contour::plant
