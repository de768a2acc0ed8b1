#include "analysis/identification/axis_model.h"

#include <numbers>

namespace contour::identify {

AxisModel FromStated(const diagnosis::StatedAxis& stated) {
  const double r = stated.linear ? 1.0 : (stated.table_per_q > 0.0 ? stated.table_per_q : 1.0);
  AxisModel axis;
  axis.radius_m_rad = r;
  axis.rigid = !stated.two_inertia;
  axis.friction_at_motor = axis.rigid || !stated.friction_on_load;
  axis.motor_mass_kg = stated.motor_inertia / (r * r);
  if (!axis.rigid) {
    axis.table_mass_kg = stated.load_inertia / (r * r);
    axis.stiffness_N_m = stated.stiffness / (r * r);
    axis.damping_Ns_m = stated.damping / (r * r);
  }
  const diagnosis::StatedFriction& f = stated.friction;
  axis.friction = {f.Fs_plus / r, f.Fs_minus / r, f.Fc_plus / r,  f.Fc_minus / r, f.vs * r,
                   f.exponent,    f.s0 / (r * r), f.s1 / (r * r), f.vd * r,       f.s2 / (r * r)};
  axis.offset_N = stated.offset / r;
  axis.delay_s = stated.delay_s;
  axis.lag_s = stated.lag_s;
  axis.turn_m = stated.linear ? stated.lead_m : 2.0 * std::numbers::pi * r;
  return axis;
}

void IntoConfig(const AxisModel& axis, ModelConfig& model) {
  const double r = axis.radius_m_rad;
  MechanicsConfig& m = model.mechanics;
  m.motor_inertia_kgm2 = axis.motor_mass_kg * r * r;
  m.table_mass_kg = axis.table_mass_kg;
  m.screw_stiffness_N_um = axis.stiffness_N_m * 1e-6;
  m.screw_damping_Ns_m = axis.damping_Ns_m;
  const Friction& f = axis.friction;
  FrictionConfig& c = model.friction;
  c.stribeck_exponent = f.stribeck_exponent;
  if (c.acts_on == FrictionSide::kTable) {
    c.Fs_plus_N = f.Fs_plus_N;
    c.Fs_minus_N = f.Fs_minus_N;
    c.Fc_plus_N = f.Fc_plus_N;
    c.Fc_minus_N = f.Fc_minus_N;
    c.vs_mm_s = f.vs_m_s * 1e3;
    c.sigma0_N_m = f.sigma0_N_m;
    c.sigma1_Ns_m = f.sigma1_Ns_m;
    c.sigma1_decay_mm_s = f.sigma1_decay_m_s * 1e3;
    c.sigma2_Ns_m = f.sigma2_Ns_m;
    return;
  }
  c.Fs_plus_Nm = f.Fs_plus_N * r;
  c.Fs_minus_Nm = f.Fs_minus_N * r;
  c.Fc_plus_Nm = f.Fc_plus_N * r;
  c.Fc_minus_Nm = f.Fc_minus_N * r;
  c.vs_rad_s = f.vs_m_s / r;
  c.sigma0_Nm_rad = f.sigma0_N_m * r * r;
  c.sigma1_Nms_rad = f.sigma1_Ns_m * r * r;
  c.sigma1_decay_rad_s = f.sigma1_decay_m_s / r;
  c.sigma2_Nms_rad = f.sigma2_Ns_m * r * r;
}

}  // namespace contour::identify
