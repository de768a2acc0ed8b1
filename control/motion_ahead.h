#pragma once

#include <algorithm>
#include <cstddef>

#include "control/contour_controller.h"
#include "control/standstill.h"

namespace contour {

/// Whether the reference moves within so many points, or an experiment pushes.
[[nodiscard]] inline bool MovesAhead(const AxisHorizon& reference, std::size_t points) noexcept {
  const std::size_t looked_at = std::min(reference.size(), points);
  for (std::size_t j = 0; j < looked_at; ++j)
    if (reference[j].velocity_m_s != 0.0 || reference[j].extra_torque_Nm != 0.0) return true;
  return false;
}

/// Any axis of the machine.
[[nodiscard]] inline bool AnyMovesAhead(const ControlInput& input, std::size_t points) noexcept {
  const auto& references = Reference(input);
  return std::any_of(references.begin(), references.end(),
                     [&](const AxisHorizon& r) { return MovesAhead(r, points); });
}

/// What there is to move for one of them, where any does or none.
[[nodiscard]] inline Standstill::Motion MotionAhead(const AxisHorizon& reference, std::size_t points,
                                                    bool any_moves) noexcept {
  if (!any_moves) return Standstill::Motion::kNone;
  return MovesAhead(reference, points) ? Standstill::Motion::kOwn : Standstill::Motion::kOfOthers;
}

}  // namespace contour
