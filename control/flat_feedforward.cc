#include "control/flat_feedforward.h"

#include <algorithm>
#include <stdexcept>

#include "control/control_law.h"

namespace contour {
namespace {

FrictionAhead FrictionAt(const FrictionPreview& friction, std::size_t index) noexcept {
  if (friction.empty()) return {};
  return friction[index < friction.size() ? index : friction.size() - 1];
}

}  // namespace

FlatFeedforward::FlatFeedforward(const ControlledAxis& axis, const ControllerOptions& options,
                                 double period_s)
    : mechanics_(axis.mechanics),
      options_(options),
      period_s_(period_s),
      bound_m_s2_(axis.limits.force_N / axis.mechanics.mass_kg),
      dynamics_(DiscretizeAxis(period_s, axis.lag_s, axis.viscous_Ns_m / axis.mechanics.mass_kg)),
      nominal_(options.friction_feedforward ? DiscretizeAxis(period_s, axis.lag_s, 0.0) : dynamics_) {
  if (!(mechanics_.mass_kg > 0.0)) throw std::invalid_argument("feed-forward: the mass must be positive");
  if (options.windup_compensation && !(mechanics_.stiffness_N_m > 0.0)) {
    throw std::invalid_argument("feed-forward: wind-up compensation needs the screw's stiffness");
  }
  // Making up for the lag is a recursion with this pole; beyond one half it would ring for many cycles.
  makes_up_lag_ = nominal_.velocity_from_previous < 0.5 * nominal_.velocity_from_command;
}

double FlatFeedforward::Windup(const ReferencePoint& point, const FrictionAhead& friction) const noexcept {
  if (!options_.windup_compensation) return 0.0;
  return (friction.node_N + mechanics_.table_mass_kg * point.acceleration_m_s2) / mechanics_.stiffness_N_m +
         friction.lead_m;
}

void FlatFeedforward::Plan(const AxisHorizon& reference, const FrictionPreview& friction,
                           double previous_command_m_s2, std::size_t horizon, AxisPlan& plan) const noexcept {
  const bool with_friction = options_.friction_feedforward && !friction.empty();
  const AxisDynamics& d = nominal_;
  const double half_rate = 0.5 / period_s_;
  const auto windup = [&](std::size_t node) {
    return Windup(PointAt(reference, node), with_friction ? FrictionAt(friction, node) : FrictionAhead{});
  };
  // Node n is t(k-1+n); w[0..3] belong to nodes n-1 .. n+2 of the interval that starts at node n.
  std::array<double, 4> w{windup(0), windup(1), windup(2), windup(3)};
  double position = PointAt(reference, 1).position_m + w[1];
  double velocity = PointAt(reference, 1).velocity_m_s + (w[2] - w[0]) * half_rate;
  plan.start_position_m = position;
  plan.start_velocity_m_s = velocity;
  double previous = previous_command_m_s2;
  for (std::size_t j = 0; j < horizon; ++j) {
    const ReferencePoint& end = PointAt(reference, j + 2);
    const double end_position = end.position_m + w[2];
    const double end_velocity = end.velocity_m_s + (w[3] - w[1]) * half_rate;
    const double w_acceleration = (w[3] - w[2] - w[1] + w[0]) * half_rate / period_s_;
    // Everything but the command: friction, and the table's mass, which takes no part in the wind-up's
    // motion.
    double known = mechanics_.table_mass_kg * w_acceleration / mechanics_.mass_kg;
    if (with_friction) known -= FrictionAt(friction, j + 1).mid_N / mechanics_.mass_kg;
    const double wanted = end_velocity - d.velocity_kept * velocity - d.velocity_from_known * known;
    const double left_over = d.velocity_from_previous * previous;
    double command = wanted / (d.velocity_from_command + d.velocity_from_previous);
    if (makes_up_lag_) command = (wanted - left_over) / d.velocity_from_command;
    // What the axis cannot do is not planned: it would be made up for in the intervals after without having
    // happened.
    command = std::clamp(command, -bound_m_s2_, bound_m_s2_);
    plan.command_m_s2[j] = command;
    plan.velocity_defect_m_s[j] = d.velocity_from_command * command + left_over - wanted;
    plan.position_defect_m[j] = position - end_position + d.position_from_velocity * velocity +
                                d.position_from_command * command + d.position_from_previous * previous +
                                d.position_from_known * known;
    if (j == 0) plan.target_position_m = end_position;
    previous = command;
    position = end_position;
    velocity = end_velocity;
    w = {w[1], w[2], w[3], windup(j + 4)};
  }
}

}  // namespace contour
