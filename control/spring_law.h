#pragma once

#include <cstddef>

#include "control/contour_controller.h"

namespace contour {

/// Where an experiment asks for it, a damped spring towards the reference takes the place of a law that holds
/// no springs itself: weak enough to let friction be felt, and no compensation answers the torque that is put
/// on. Has no state.
class SpringLaw {
 public:
  explicit SpringLaw(const PerAxis<ControlledAxis>& axes) noexcept;

  /// The experiment asks for it, on this axis and in this cycle.
  [[nodiscard]] static bool Holds(const ControlInput& input, std::size_t axis) noexcept;
  /// What holds a weight that the model states, without which the spring would give way under it.
  [[nodiscard]] static double AgainstStated_N(const ControlInput& input, std::size_t axis) noexcept;
  /// Writes the output of one axis that it holds.
  void Step(std::size_t axis, const ControlInput& input, ControlOutput& output) const noexcept;

 private:
  PerAxis<double> mass_kg_;
};

}  // namespace contour
