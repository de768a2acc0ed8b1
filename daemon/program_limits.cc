#include "daemon/program_limits.h"

#include <algorithm>
#include <cmath>

#include "config/loop_axis.h"
#include "drivers/cia402/mode_for.h"

namespace contour {

namespace {

/// Who starts a machine puts what is expected of its loops there (design/path_following.h); without, the
/// screws tell.
double PathFollowing_m(const MachineConfig& machine) {
  if (machine.machine.path_following_mm) return *machine.machine.path_following_mm * 1e-3;
  return WindUpUnderForceStep_m(machine);
}

/// By what is not known of the table's mass, the screw's stiffness and Coulomb friction, one standard
/// deviation: what the screw gives under the rest.
struct ScrewDoubt {
  double inertia_s2 = 0.0;
  double friction_m = 0.0;
};

ScrewDoubt DoubtOf(const AxisConfig& axis) {
  const LoopAxis a = LoopAxisOf(axis);
  const auto stated = axis.model.uncertainty.find("Fc_plus_N");
  const double friction_std =
      stated == axis.model.uncertainty.end() ? axis.loop_limits.uncertainty : stated->second;
  const double coulomb_N = std::max(a.friction.Fc_plus_N, a.friction.Fc_minus_N);
  return {a.axis.table_mass_kg / a.axis.stiffness_N_m * std::hypot(a.table_mass_std, a.stiffness_std),
          coulomb_N / a.axis.stiffness_N_m * friction_std};
}

}  // namespace

PerAxis<PlanLimits> ProgramLimits(const MachineConfig& machine) {
  PerAxis<PlanLimits> limits;
  // What is learnt may shift a program by so much.
  const double margin_m = machine.learning.enabled ? 1e-6 * machine.learning.largest_um : 0.0;
  const double following_m = PathFollowing_m(machine),
               tolerance_m = 1e-3 * PathTolerance_mm(machine, 1e3 * following_m);
  for (const auto& [name, axis] : machine.axes) {
    const AxisLimits& l = axis.limits;
    const Mechanics mechanics = ToSi(axis.model.mechanics);
    limits.push_back({name, l.position_mm[0] * 1e-3 + margin_m, l.position_mm[1] * 1e-3 - margin_m,
                      l.velocity_mm_s * 1e-3, l.acceleration_mm_s2 * 1e-3, l.jerk_mm_s3 * 1e-3, l.torque_Nm,
                      l.following_error_mm * 1e-3, mechanics.radius_m_rad, mechanics.mass_kg, tolerance_m,
                      following_m});
    limits.back().cycle_s = 1e-6 * machine.machine.cycle_us;
    if (KnowsTwoInertias(machine.machine.controller, machine.control.friction) &&
        ModeFor(machine.machine.controller, axis.drive) == DriveMode::kCst)
      limits.back().stiffest_spring_N_m = StiffestSpring_N_m(axis, limits.back().cycle_s);
    // A loop on the scale sees the table itself.
    if (!machine.machine.slow_for_tolerance || (axis.scale_loop && axis.drive.linear_scale)) continue;
    const ScrewDoubt doubt = DoubtOf(axis);
    limits.back().inertia_doubt_s2 = doubt.inertia_s2;
    limits.back().friction_doubt_m = doubt.friction_m;
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
