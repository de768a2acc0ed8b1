#include "control/flat_feedforward.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/wide_vectors.h"

namespace contour {
namespace {

using Row = std::array<double, kMaxHorizonPoints>;
static_assert(kMaxHorizon + 4 <= kMaxHorizonPoints);

}  // namespace

struct FlatFeedforward::Nodes {
  Row position_m, velocity_m_s, windup_m;
  Row mid_N;  // friction
};

// Beyond the ends of reference and friction their last elements hold.
[[gnu::always_inline]] inline void FlatFeedforward::Lay(const AxisHorizon& reference,
                                                        const FrictionPreview& friction, std::size_t nodes,
                                                        Nodes& at) const noexcept {
  Row acceleration_m_s2, node_N, lead_m;
  const std::size_t there = std::min(nodes, reference.size());
  for (std::size_t n = 0; n < there; ++n) {
    at.position_m[n] = reference[n].position_m;
    at.velocity_m_s[n] = reference[n].velocity_m_s;
    acceleration_m_s2[n] = reference[n].acceleration_m_s2;
  }
  for (std::size_t n = there; n < nodes; ++n) {
    at.position_m[n] = at.position_m[there - 1];
    at.velocity_m_s[n] = at.velocity_m_s[there - 1];
    acceleration_m_s2[n] = acceleration_m_s2[there - 1];
  }
  if (options_.friction_feedforward && !friction.empty()) {
    const std::size_t known = std::min(nodes, friction.size());
    for (std::size_t n = 0; n < known; ++n) {
      node_N[n] = friction[n].node_N;
      at.mid_N[n] = friction[n].mid_N;
      lead_m[n] = friction[n].lead_m;
    }
    for (std::size_t n = known; n < nodes; ++n) {
      node_N[n] = node_N[known - 1];
      at.mid_N[n] = at.mid_N[known - 1];
      lead_m[n] = lead_m[known - 1];
    }
  } else {
    for (std::size_t n = 0; n < nodes; ++n) node_N[n] = at.mid_N[n] = lead_m[n] = 0.0;
  }
  if (!options_.windup_compensation) {
    for (std::size_t n = 0; n < nodes; ++n) at.windup_m[n] = 0.0;
    return;
  }
  const double table_mass = mechanics_.table_mass_kg, stiffness = mechanics_.stiffness_N_m;
  for (std::size_t n = 0; n < nodes; ++n)
    at.windup_m[n] = (node_N[n] + table_mass * acceleration_m_s2[n]) / stiffness + lead_m[n];
}

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

// Quantities that hold at a node or over an interval are rows, so that all but the recursion of the commands
// vectorises.
CONTOUR_WIDE_VECTORS
void FlatFeedforward::Plan(const AxisHorizon& reference, const FrictionPreview& friction,
                           double previous_command_m_s2, std::size_t horizon, AxisPlan& plan) const noexcept {
  // Node n is t(k-1+n). The interval j lies between nodes j+1 and j+2, and its wind-up's derivatives need one
  // more on either side.
  const std::size_t nodes = horizon + 4;
  Nodes at;
  Lay(reference, friction, nodes, at);
  const AxisDynamics d = nominal_;
  const double mass = mechanics_.mass_kg, table_mass = mechanics_.table_mass_kg;
  const double half_rate = 0.5 / period_s_, period_s = period_s_;
  Row position, velocity;  // of the motor
  for (std::size_t n = 1; n + 1 < nodes; ++n) {
    position[n] = at.position_m[n] + at.windup_m[n];
    velocity[n] = at.velocity_m_s[n] + (at.windup_m[n + 1] - at.windup_m[n - 1]) * half_rate;
  }
  Row known, wanted;
  for (std::size_t j = 0; j < horizon; ++j) {
    const double w_acceleration =
        (at.windup_m[j + 3] - at.windup_m[j + 2] - at.windup_m[j + 1] + at.windup_m[j]) * half_rate /
        period_s;
    // Everything but the command: friction, and the table's mass, which takes no part in the wind-up's
    // motion.
    known[j] = table_mass * w_acceleration / mass - at.mid_N[j + 1] / mass;
    wanted[j] = velocity[j + 2] - d.velocity_kept * velocity[j + 1] - d.velocity_from_known * known[j];
  }
  Row command;  // of the interval before j in element j
  command[0] = previous_command_m_s2;
  // Each command waits for the one before: as little as possible stands between them.
  const double per_gain = 1.0 / (d.velocity_from_command + (makes_up_lag_ ? 0.0 : d.velocity_from_previous));
  const double made_up = makes_up_lag_ ? d.velocity_from_previous * per_gain : 0.0;
  const double bound = bound_m_s2_;
  for (std::size_t j = 0; j < horizon; ++j) command[j + 1] = wanted[j] * per_gain;
  for (std::size_t j = 0; j < horizon; ++j) {
    // What the axis cannot do is not planned: it would be made up for in the intervals after without having
    // happened.
    command[j + 1] = std::min(std::max(command[j + 1] - made_up * command[j], -bound), bound);
  }
  for (std::size_t j = 0; j < horizon; ++j) {
    plan.command_m_s2[j] = command[j + 1];
    plan.velocity_defect_m_s[j] =
        d.velocity_from_command * command[j + 1] + d.velocity_from_previous * command[j] - wanted[j];
    plan.position_defect_m[j] = position[j + 1] - position[j + 2] +
                                d.position_from_velocity * velocity[j + 1] +
                                d.position_from_command * command[j + 1] +
                                d.position_from_previous * command[j] + d.position_from_known * known[j];
  }
  plan.start_position_m = position[1];
  plan.start_velocity_m_s = velocity[1];
  plan.target_position_m = position[2];
}

}  // namespace contour
