#include "analysis/axis_model/apply_extensions.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "config/extended_friction.h"

namespace contour::diagnosis {
namespace {

StatedTable Table(const std::vector<double>& position_mm, const std::vector<double>& values, double unit) {
  StatedTable t;
  for (const double x : position_mm) t.position_m.push_back(1e-3 * x);
  for (const double y : values) t.value.push_back(unit * y);
  return t;
}

std::vector<StatedWave> Ripples(const std::optional<RippleExtension>& e) {
  std::vector<StatedWave> waves;
  if (!e) return waves;
  waves.push_back({e->amplitude_rel, e->order_per_rev, e->phase_rad});
  for (const RippleWave& w : e->further) waves.push_back({w.amplitude_rel, w.order_per_rev, w.phase_rad});
  return waves;
}

void Apply(const ComplianceExtension& e, StatedAxis& axis) {
  if (!axis.two_inertia) {
    // The antiresonance is the load's on the stiffness; the motor keeps the rest.
    const double w_rad_s = 2.0 * std::numbers::pi * e.antiresonance_Hz;
    const double load = w_rad_s > 0.0 ? e.stiffness_Nm_rad / (w_rad_s * w_rad_s) : 0.0;
    if (load <= 0.0 || load >= axis.motor_inertia) return;
    axis.two_inertia = true;
    axis.friction_on_load = false;
    axis.load_inertia = load;
    axis.motor_inertia -= load;
  }
  const double reduced = axis.motor_inertia * axis.load_inertia / (axis.motor_inertia + axis.load_inertia);
  axis.stiffness = e.stiffness_Nm_rad;
  axis.damping = 2.0 * e.damping_ratio * std::sqrt(e.stiffness_Nm_rad * reduced);
}

}  // namespace

void ApplyNumbers(const ExtensionsConfig& x, StatedAxis& axis) {
  StatedFriction& f = axis.friction;
  const FrictionNumbers friction = {&f.Fs_plus, &f.Fs_minus, &f.Fc_plus, &f.Fc_minus, &f.vs,
                                    &f.s0,      &f.s1,       &f.s2,      1.0};
  if (x.asymmetric_coulomb) Apply(*x.asymmetric_coulomb, friction);
  if (x.stribeck) Apply(*x.stribeck, friction);
  if (x.compliance) Apply(*x.compliance, axis);
  if (x.torque_constant)
    Apply(*x.torque_constant, friction,
          {&axis.motor_inertia, &axis.load_inertia, &axis.stiffness, &axis.damping});
  if (x.input_delay) axis.delay_s += 1e-6 * x.input_delay->delay_us;
  if (x.current_lag) axis.lag_s += 1e-6 * x.current_lag->time_constant_us;
}

void ApplyExtras(const ExtensionsConfig& x, StatedAxis& axis) {
  // Forces of the real machine, in units of the torque that is asked for.
  const double per_Nm = x.torque_constant ? 1.0 / x.torque_constant->ratio : 1.0;
  StatedExtras& out = axis.extras;
  if (const auto& e = x.constant_torque) axis.offset += per_Nm * e->torque_Nm;
  if (const auto& e = x.cogging) {
    out.cogging.push_back({per_Nm * e->amplitude_Nm, e->order_per_rev, e->phase_rad});
    for (const CoggingWave& w : e->further)
      out.cogging.push_back({per_Nm * w.amplitude_Nm, w.order_per_rev, w.phase_rad});
  }
  out.friction_ripple = Ripples(x.friction_ripple);
  out.ball_ripple = Ripples(x.ball_ripple);
  if (const auto& e = x.position_friction) out.friction_rel = Table(e->position_mm, e->friction_rel, 1.0);
  if (const auto& e = x.cable_spring) out.spring = Table(e->position_mm, e->torque_Nm, per_Nm);
  if (const auto& e = x.pitch_error) out.pitch_error_m = Table(e->position_mm, e->error_um, 1e-6);
  if (const auto& e = x.lead_wobble) {
    out.wobble_m.push_back({1e-6 * e->amplitude_um, e->order_per_rev, e->phase_rad});
    for (const WobbleWave& w : e->further)
      out.wobble_m.push_back({1e-6 * w.amplitude_um, w.order_per_rev, w.phase_rad});
  }
  const auto add_drag = [&](const ViscousCurve& e) {
    out.drag.push_back(
        {per_Nm * e.torque_at_max_speed_Nm, e.max_speed_rad_s, e.exponent, e.knee_rad_s / e.max_speed_rad_s});
  };
  if (const auto& e = x.viscous_nonlinear) {
    add_drag(*e);
    for (const ViscousCurve& curve : e->further) add_drag(curve);
  }
  if (const auto& e = x.asymmetric_viscous) out.viscous_difference_rel = e->difference_rel;
  if (const auto& e = x.temperature_viscosity) {
    out.viscous_rate_1_K = e->rate_1_K;
    out.reference_degC = e->reference_degC;
  }
}

}  // namespace contour::diagnosis
