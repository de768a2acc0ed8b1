#include "config/loop_axis.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "config/extended_model.h"
#include "core/spring_loop.h"

namespace contour {

TwoInertiaAxis TwoInertiaAxisOf(const AxisConfig& axis) {
  const ExtendedModel model = Extended(axis.model);
  const Mechanics mechanics = ToSi(model.mechanics);
  const double sigma2_Ns_m = ToSi(model.friction, mechanics.radius_m_rad).sigma2_Ns_m;
  const double lag_s = std::max(0.0, 1e-3 * axis.drive.lag_ms + model.added_lag_s);
  TwoInertiaAxis out = ToTwoInertiaAxis(mechanics, sigma2_Ns_m, lag_s, axis.drive.delay_cycles);
  // The cycle cannot know of less than its own delay.
  out.dead_time_s = std::max(0.0, model.added_delay_s);
  return out;
}

LoopAxis LoopAxisOf(const AxisConfig& axis) {
  const ExtendedModel model = Extended(axis.model);
  const Mechanics mechanics = ToSi(model.mechanics);
  LoopAxis out;
  out.friction = ToSi(model.friction, mechanics.radius_m_rad);
  out.axis = TwoInertiaAxisOf(axis);
  out.rated_force_N = axis.drive.rated_torque_Nm / mechanics.radius_m_rad;
  out.most_force_N = axis.limits.torque_Nm / mechanics.radius_m_rad;
  out.encoder_step_m = 1e-3 * model.mechanics.lead_mm / axis.drive.encoder_counts_per_rev;
  out.limits = axis.loop_limits;
  const auto std_of = [&](const char* key) {
    const auto stated = axis.model.uncertainty.find(key);
    const double value =
        stated == axis.model.uncertainty.end() ? axis.loop_limits.uncertainty : stated->second;
    return std::max(value, axis.loop_limits.smallest_uncertainty);
  };
  out.stiffness_std = std_of("screw_stiffness_N_um");
  out.motor_mass_std = std_of("motor_inertia_kgm2");
  out.table_mass_std = std_of("table_mass_kg");
  for (const char* key : {"Fc_plus_N", "Fc_minus_N", "Fc_plus_Nm", "Fc_minus_Nm"})
    if (axis.model.uncertainty.contains(key)) out.friction_std = std::max(out.friction_std, std_of(key));
  if (out.friction_std == 0.0) out.friction_std = axis.loop_limits.uncertainty;
  const auto share = axis.model.uncertainty.find("motor_share_rel");
  if (share != axis.model.uncertainty.end()) out.motor_share_std = share->second;
  out.side_modes = axis.model.side_modes;
  return out;
}

std::optional<LoopAxis> ScaleLoopAxisOf(const AxisConfig& axis) {
  if (!axis.drive.linear_scale) return std::nullopt;
  LoopAxis out = LoopAxisOf(axis);
  out.scale_step_m = 1e-3 / axis.drive.linear_scale->counts_per_mm;
  return out;
}

double StiffestSpring_N_m(const AxisConfig& axis, double period_s) {
  double stiffest_N_m = std::numeric_limits<double>::infinity();
  if (!axis.loop) return stiffest_N_m;
  try {
    const TwoInertiaAxis two = TwoInertiaAxisOf(axis);
    stiffest_N_m = StiffestSpring_N_m(DesignLoop(two, *axis.loop, period_s, false));
    if (axis.drive.linear_scale && axis.scale_loop)
      stiffest_N_m =
          std::min(stiffest_N_m, StiffestSpring_N_m(DesignLoop(two, *axis.scale_loop, period_s, true)));
  } catch (const std::invalid_argument&) {
    // Whoever makes the cycle says what is wrong with the loop.
  }
  return stiffest_N_m;
}

double WindUpUnderForceStep_m(const AxisConfig& axis) {
  const LoopAxis a = LoopAxisOf(axis);
  return a.limits.force_step * a.rated_force_N / a.axis.stiffness_N_m;
}

double WindUpUnderForceStep_m(const MachineConfig& machine) {
  double most_m = 0.0;
  for (const auto& [name, axis] : machine.axes) most_m = std::max(most_m, WindUpUnderForceStep_m(axis));
  return most_m;
}

double PathTolerance_mm(const MachineConfig& machine, double following_mm) {
  return machine.machine.path_tolerance_mm.value_or(std::max(kUsualPathTolerance_mm, 2.0 * following_mm));
}

}  // namespace contour
