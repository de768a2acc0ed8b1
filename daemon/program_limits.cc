#include "daemon/program_limits.h"

#include "config/loop_axis.h"

namespace contour {

namespace {

/// Who starts a machine puts what is expected of its loops there (design/path_following.h); without, the
/// screws tell.
double PathFollowing_m(const MachineConfig& machine) {
  if (machine.machine.path_following_mm) return *machine.machine.path_following_mm * 1e-3;
  return WindUpUnderForceStep_m(machine);
}

}  // namespace

PerAxis<PlanLimits> ProgramLimits(const MachineConfig& machine) {
  PerAxis<PlanLimits> limits;
  // What is learnt may shift a program by so much.
  const double margin_m = machine.learning.enabled ? 1e-6 * machine.learning.largest_um : 0.0;
  const double following_m = PathFollowing_m(machine);
  for (const auto& [name, axis] : machine.axes) {
    const AxisLimits& l = axis.limits;
    const Mechanics mechanics = ToSi(axis.model.mechanics);
    limits.push_back({name, l.position_mm[0] * 1e-3 + margin_m, l.position_mm[1] * 1e-3 - margin_m,
                      l.velocity_mm_s * 1e-3, l.acceleration_mm_s2 * 1e-3, l.jerk_mm_s3 * 1e-3, l.torque_Nm,
                      l.following_error_mm * 1e-3, mechanics.radius_m_rad, mechanics.mass_kg,
                      machine.machine.path_tolerance_mm * 1e-3, following_m});
  }
  return limits;
}

PerAxis<PlanLimits> LimitsNow(const PerAxis<PlanLimits>& limits, const CycleRecord& now) {
  PerAxis<PlanLimits> out = limits;
  for (std::size_t i = 0; i < out.size() && i < now.axes.size(); ++i) {
    const AxisRecord& axis = now.axes[i];
    if (IsReferenced(axis.reference_state)) continue;
    out[i].position_min_m = axis.travel_min_m;
    out[i].position_max_m = axis.travel_max_m;
  }
  return out;
}

}  // namespace contour
