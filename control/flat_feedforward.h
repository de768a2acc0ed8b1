#pragma once

#include <array>
#include <cstddef>

#include "control/axis_dynamics.h"
#include "control/contour_controller.h"
#include "core/horizon.h"
#include "core/mechanics.h"

namespace contour {

/// What one axis is to do over the horizon: interval j is [t(k+j), t(k+j+1)).
struct AxisPlan {
  double start_position_m = 0.0;  ///< motor side, at t(k)
  double start_velocity_m_s = 0.0;
  std::array<double, kMaxHorizon> command_m_s2{};  ///< feed-forward force per mass
  /// By which the feed-forward, through the exact model, misses the next point of the reference.
  std::array<double, kMaxHorizon> position_defect_m{};
  std::array<double, kMaxHorizon> velocity_defect_m_s{};
  double target_position_m = 0.0;  ///< motor side, at t(k+1)
};

/// Feed-forward of a ball screw from the flat output, the table: with the friction F ahead the spring carries
/// F + Mt a, so the motor leads the table by w = (F + Mt a) / K, and the force that makes it do so is
/// F + m a + (m - Mt) w''. Derivatives of w are central differences. The force wanted over an interval is the
/// one that really acts there: what the drive's lag leaves over from the interval before is made up for.
class FlatFeedforward {
 public:
  FlatFeedforward(const ControlledAxis& axis, const ControllerOptions& options, double period_s);

  [[nodiscard]] const AxisDynamics& dynamics() const noexcept { return dynamics_; }

  /// `previous_command_m_s2`: feed-forward command of the interval [t(k-1), t(k)). Empty friction counts as
  /// none.
  void Plan(const AxisHorizon& reference, const FrictionPreview& friction, double previous_command_m_s2,
            std::size_t horizon, AxisPlan& plan) const noexcept;

 private:
  /// Reference, friction and wind-up at the nodes.
  struct Nodes;
  void Lay(const AxisHorizon& reference, const FrictionPreview& friction, std::size_t nodes,
           Nodes& at) const noexcept;

  Mechanics mechanics_;
  ControllerOptions options_;
  double period_s_;
  double bound_m_s2_;
  AxisDynamics dynamics_;
  AxisDynamics nominal_;  ///< of the reference: a friction preview has the viscous part in it
  bool makes_up_lag_;
};

}  // namespace contour
