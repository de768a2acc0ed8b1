#include "control/torque_guard.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace contour {

TorqueGuard::TorqueGuard(const GuardConfig& config, const PerAxis<GuardedAxis>& axes, double period_s,
                         WatchesOff off)
    : config_(config), off_(off), axes_(axes), memory_(axes.size()), period_s_(period_s) {
  if (!(period_s > 0.0)) throw std::invalid_argument("torque guard: the period must be positive");
  for (const GuardedAxis& axis : axes_) {
    if (!(axis.limits.torque_Nm > 0.0) || !(axis.radius_m_rad > 0.0)) {
      throw std::invalid_argument("torque guard: torque limit and screw radius must be positive");
    }
  }
  Reset();
}

void TorqueGuard::Reset() noexcept {
  for (Memory& memory : memory_) memory = Memory{};
}

void TorqueGuard::Skip(std::uint32_t periods) noexcept {
  for (Memory& memory : memory_) memory.cycles_since_position += periods;
}

GuardedTorque TorqueGuard::Limit(std::size_t axis, double wanted_torque_Nm, const AxisFeedback& feedback,
                                 double reference_position_m, bool enabled, double sync_apart_s) noexcept {
  GuardedTorque out;
  Memory& memory = memory_[axis];
  out.fault = FindFault(axis, wanted_torque_Nm, feedback, reference_position_m, enabled, sync_apart_s);
  if (!enabled || out.fault != Reason::kNone) {
    memory.torque_Nm = 0.0;
    return out;
  }
  const AxisLimitsSi& limits = axes_[axis].limits;
  const double within = std::clamp(wanted_torque_Nm, -limits.torque_Nm, limits.torque_Nm);
  if (within != wanted_torque_Nm) out.limit = Reason::kTorqueLimit;
  const double step = limits.torque_rate_Nm_s * period_s_;
  out.torque_Nm = std::clamp(within, memory.torque_Nm - step, memory.torque_Nm + step);
  if (out.torque_Nm != within) out.limit = Reason::kTorqueRateLimit;
  memory.torque_Nm = out.torque_Nm;
  return out;
}

Reason TorqueGuard::FindFault(std::size_t axis, double wanted_torque_Nm, const AxisFeedback& feedback,
                              double reference_position_m, bool enabled, double sync_apart_s) noexcept {
  Memory& memory = memory_[axis];
  const AxisLimitsSi& limits = axes_[axis].limits;
  const double position = feedback.position_rad * axes_[axis].radius_m_rad;
  if (!std::isfinite(wanted_torque_Nm) || !std::isfinite(position) || !std::isfinite(reference_position_m)) {
    return Reason::kNotANumber;
  }
  double velocity = 0.0, over_s = 0.0;
  ++memory.cycles_since_position;
  if (feedback.fresh) {
    if (memory.has_position) {
      over_s = period_s_ * memory.cycles_since_position;
      velocity = (position - memory.position_m) / over_s;
    }
    memory.position_m = position;
    memory.cycles_since_position = 0;
    memory.has_position = true;
  }
  if (!enabled) {
    memory.was_enabled = false;
    return Reason::kNone;
  }
  if (!memory.was_enabled) {
    // An axis that stands outside its limits, after a fault there, must be able to be driven back.
    memory.was_enabled = true;
    const double beyond = limits.following_error_m;
    memory.allowed_min_m = position < limits.position_min_m ? position - beyond : limits.position_min_m;
    memory.allowed_max_m = position > limits.position_max_m ? position + beyond : limits.position_max_m;
    if (memory.confined_to_m > 0.0) {
      memory.allowed_min_m = position - memory.confined_to_m;
      memory.allowed_max_m = position + memory.confined_to_m;
    }
  }
  const bool stale =
      !feedback.valid || feedback.age_cycles >= static_cast<std::uint32_t>(config_.stale_cycles);
  if (stale && off_.Acts(Watch::kStaleFeedback)) return Reason::kStaleFeedback;
  const double fastest_m_s = config_.overspeed_factor * limits.velocity_m_s;
  // Where its SYNC waited for another frame, a reading shows the way of longer than a cycle.
  const bool too_fast = std::abs(velocity) > fastest_m_s &&
                        std::abs(velocity) * over_s > fastest_m_s * (over_s + std::max(sync_apart_s, 0.0));
  if (too_fast && off_.Acts(Watch::kVelocityLimit)) return Reason::kVelocityLimit;
  const bool beyond = position < memory.allowed_min_m || position > memory.allowed_max_m;
  if (beyond && off_.Acts(Watch::kPositionLimit)) return Reason::kPositionLimit;
  // Without new feedback the distance to a moving reference grows by itself.
  const bool off_path =
      feedback.fresh && std::abs(reference_position_m - position) > limits.following_error_m;
  if (off_path && off_.Acts(Watch::kFollowingError)) return Reason::kFollowingError;
  return Reason::kNone;
}

}  // namespace contour
