#include "control/pid_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour {

PidLaw::PidLaw(const PidConfig& config, const ControllerOptions& options, const PerAxis<ControlledAxis>& axes,
               double period_s)
    : options_(options),
      period_s_(period_s),
      integral_1_s_(2.0 * std::numbers::pi * config.integral_Hz),
      filter_(std::exp(-2.0 * std::numbers::pi * config.derivative_filter_Hz * period_s)),
      gains_(axes.size()),
      memory_(axes.size()) {
  const double omega = 2.0 * std::numbers::pi * config.bandwidth_Hz;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double mass = axes[i].mechanics.mass_kg;
    gains_[i] = {mass,
                 axes[i].viscous_Ns_m,
                 mass * omega * omega,
                 2.0 * config.damping * mass * omega,
                 axes[i].limits.force_N,
                 axes[i].limits.force_rate_N_s * period_s};
  }
  Reset();
}

void PidLaw::Reset() noexcept {
  for (AxisMemory& memory : memory_) memory = AxisMemory{};
}

void PidLaw::Step(const ControlInput& input, ControlOutput& output) noexcept {
  output.iterations = 0;
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    const AxisGains& gains = gains_[i];
    AxisMemory& memory = memory_[i];
    const ReferencePoint& sampled = PointAt(Reference(input)[i], 0);
    const ReferencePoint& start = PointAt(Reference(input)[i], 1);
    const ReferencePoint& end = PointAt(Reference(input)[i], 2);

    const double error = sampled.position_m - input.estimate[i].position_m;
    if (memory.has_error) {
      const double raw = (error - memory.position_error_m) / period_s_;
      memory.velocity_error_m_s = filter_ * memory.velocity_error_m_s + (1.0 - filter_) * raw;
    }
    memory.position_error_m = error;
    memory.has_error = true;

    double feedforward = gains.mass_kg * (end.velocity_m_s - start.velocity_m_s) / period_s_;
    if (options_.friction_feedforward && input.friction[i].size() > 1) {
      feedforward += input.friction[i][1].mid_N;
    } else {
      feedforward += gains.viscous_Ns_m * 0.5 * (start.velocity_m_s + end.velocity_m_s);
    }
    const double feedback = gain_share_ * (gain_share_ * gains.proportional_N_m * error +
                                           gains.derivative_Ns_m * memory.velocity_error_m_s);
    const double wanted = feedforward + feedback + memory.integral_N;
    const double within = std::clamp(wanted, -gains.force_N, gains.force_N);
    const double previous = input.previous_force_N[i];
    const double reachable = std::clamp(previous, -gains.force_N, gains.force_N);
    const double force = std::clamp(within, reachable - gains.step_N, reachable + gains.step_N);
    const double step =
        gain_share_ * gain_share_ * gain_share_ * gains.proportional_N_m * integral_1_s_ * period_s_ * error;
    if (force == wanted || (wanted - force) * step < 0.0) memory.integral_N += step;

    output.force_N[i] = force;
    output.feedforward_N[i] = feedforward;
    output.target_position_m[i] = end.position_m;
    output.limit[i] = within != wanted ? Reason::kTorqueLimit : Reason::kNone;
    if (force != within) output.limit[i] = Reason::kTorqueRateLimit;
  }
}

}  // namespace contour
