#pragma once

#include "control/contour_controller.h"
#include "core/nonblocking.h"
#include "core/state_keeper.h"

namespace contour {

/// One way of turning reference and estimate into force.
class ControlLaw {
 public:
  virtual ~ControlLaw() = default;
  virtual void Reset() noexcept CONTOUR_NONBLOCKING = 0;
  /// This axis is not under this law's control in this cycle: its integrator must not wind up.
  virtual void Release(std::size_t axis) noexcept CONTOUR_NONBLOCKING = 0;
  /// Part of the state that Keep keeps; Reset leaves it.
  virtual void Soften(Softness softness) noexcept CONTOUR_NONBLOCKING = 0;
  virtual void Step(const ControlInput& input, ControlOutput& output) noexcept CONTOUR_NONBLOCKING = 0;
  /// It holds axes by an experiment's spring itself: SpringLaw is not to take its place.
  [[nodiscard]] virtual bool holds_springs() const noexcept CONTOUR_NONBLOCKING { return false; }
  [[nodiscard]] virtual int horizon_points() const noexcept CONTOUR_NONBLOCKING = 0;
  /// What changes from Step to Step; gains and all that follows from them stay as constructed.
  virtual void Keep(StateKeeper& keep) noexcept CONTOUR_NONBLOCKING = 0;
};

/// Of the torque offset, where the drive closes the loop.
constexpr double OffsetShare(Softness softness) noexcept {
  return softness == Softness::kNone ? 1.0 : softness == Softness::kSofter ? 0.5 : 0.0;
}

/// Point of a horizon; beyond its end the last one.
inline const ReferencePoint& PointAt(const AxisHorizon& horizon, std::size_t index) noexcept {
  return horizon[index < horizon.size() ? index : horizon.size() - 1];
}

}  // namespace contour
