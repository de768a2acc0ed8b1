#include "control/csp_law.h"

#include <algorithm>
#include <cmath>

namespace contour {

CspLaw::CspLaw(const CspConfig& config, const ControllerOptions& options, const PerAxis<ControlledAxis>& axes,
               double period_s)
    : torque_offset_(config.torque_offset), axes_(axes) {
  for (ControlledAxis axis : axes_) {
    axis.lag_s = 0.0;  // the offset enters the drive's loop, which knows its lag
    feedforward_.emplace_back(axis, options, period_s);
  }
}

void CspLaw::Reset() noexcept {}

void CspLaw::Step(const ControlInput& input, ControlOutput& output) noexcept {
  output.iterations = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const FlatFeedforward& feedforward = feedforward_[i];
    feedforward.Plan(Reference(input)[i], input.friction[i], 0.0, 1, plan_);
    const double wanted = plan_.command_m_s2[0] * axes_[i].mechanics.mass_kg;
    const double limit = axes_[i].limits.force_N;
    output.feedforward_N[i] = wanted;
    output.force_N[i] = torque_offset_ ? share_ * std::clamp(wanted, -limit, limit) : 0.0;
    output.limit[i] = torque_offset_ && std::abs(wanted) > limit ? Reason::kTorqueLimit : Reason::kNone;
    output.target_position_m[i] = plan_.target_position_m;
  }
}

}  // namespace contour
