#include "daemon/make_cycle_config.h"

#include <algorithm>
#include <cmath>

#include "config/extended_model.h"
#include "config/loop_axis.h"
#include "config/motion_bounds.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

CycleAxisConfig MakeAxis(const std::string& name, const AxisConfig& axis, const EstimatorConfig& estimator) {
  CycleAxisConfig out;
  out.name = name;
  const ExtendedModel model = Extended(axis.model);
  out.mechanics = ToSi(model.mechanics);
  out.friction = model.friction;
  out.known = KnownEffects(axis.model.extensions, out.mechanics,
                           ToSi(out.friction, out.mechanics.radius_m_rad).sigma2_Ns_m);
  out.side_modes = axis.model.side_modes;
  out.estimator = estimator;
  // What is known well is not to be learnt anew.
  const auto stated = axis.model.uncertainty.find("screw_stiffness_N_um");
  if (stated != axis.model.uncertainty.end() && out.estimator.stiffness_std > 0.0)
    out.estimator.stiffness_std = stated->second;
  out.limits = axis.limits;
  // A delay of a fraction of a period does to the axis what a lag of that time constant does, to first order.
  out.lag_s = std::max(0.0, axis.drive.lag_ms * 1e-3 + model.added_lag_s + model.added_delay_s);
  out.two_inertia = TwoInertiaAxisOf(axis);
  out.encoder_counts_per_rev = static_cast<double>(axis.drive.encoder_counts_per_rev);
  out.loop = axis.loop;
  out.peak_late = axis.loop_limits.peak_late;
  out.has_scale = axis.drive.linear_scale.has_value();
  if (out.has_scale) out.scale_loop = axis.scale_loop;
  return out;
}

}  // namespace

CycleConfig MakeCycleConfig(const MachineConfig& machine, ControllerName controller) {
  CycleConfig out;
  out.cycle_us = static_cast<std::uint32_t>(machine.machine.cycle_us);
  out.controller = controller;
  out.control = machine.control;
  out.master.cycle_us = out.cycle_us;
  for (const auto& [name, bus] : machine.buses) out.master.buses.push_back(bus);
  for (const auto& [name, axis] : machine.axes) {
    out.axes.push_back(MakeAxis(name, axis, machine.estimator));
    AxisDriveConfig drive{name, static_cast<std::uint8_t>(BusIndex(machine, axis.drive.bus)), axis.drive,
                          std::min(axis.limits.torque_Nm, axis.drive.peak_torque_Nm),
                          1e-3 * axis.limits.safe_travel_mm / out.axes.back().mechanics.radius_m_rad};
    const double r_m = out.axes.back().mechanics.radius_m_rad,
                 speed_rad_s = 1e-3 * axis.limits.velocity_mm_s / r_m;
    // An absolute encoder is right wherever the axis was moved to by hand while its drive was off, as long as
    // that is where the axis can be.
    const double stroke_rad = 1e-3 * (axis.limits.position_mm[1] - axis.limits.position_mm[0]) / r_m;
    if (axis.drive.absolute_encoder) drive.unseen_travel_rad += stroke_rad;
    const double coast_mm = CoastTravel_mm(axis);
    if (std::isfinite(coast_mm))
      drive.coast_s2_rad = 1e-3 * coast_mm / r_m / (speed_rad_s * speed_rad_s);
    else if (axis.drive.absolute_encoder)
      drive.unseen_travel_rad += stroke_rad;  // it falls to the machine's own stop, wherever that is beyond
    drive.drive.mode = ModeFor(controller, axis.drive);
    out.master.axes.push_back(drive);
  }
  return out;
}

}  // namespace contour
