#include "config/extended_model.h"

#include <cmath>

#include "config/extended_friction.h"

namespace contour {
namespace {

/// Those that count: of the side it is stated for.
FrictionNumbers NumbersOf(FrictionConfig& f, double radius_m_rad) {
  if (f.acts_on == FrictionSide::kMotor)
    return {&f.Fs_plus_Nm,     &f.Fs_minus_Nm,    &f.Fc_plus_Nm,
            &f.Fc_minus_Nm,    &f.vs_rad_s,       &f.sigma0_Nm_rad,
            &f.sigma1_Nms_rad, &f.sigma2_Nms_rad, 1.0};
  return {&f.Fs_plus_N,  &f.Fs_minus_N,  &f.Fc_plus_N,   &f.Fc_minus_N,     &f.vs_mm_s,
          &f.sigma0_N_m, &f.sigma1_Ns_m, &f.sigma2_Ns_m, radius_m_rad * 1e3};
}

void Apply(const ComplianceExtension& e, MechanicsConfig& m) {
  const double r = ScrewRadius_m_rad(m.lead_mm);
  const double stiffness_N_m = e.stiffness_Nm_rad / (r * r);
  const double motor_kg = m.motor_inertia_kgm2 / (r * r);
  const double reduced_kg = motor_kg * m.table_mass_kg / (motor_kg + m.table_mass_kg);
  m.screw_stiffness_N_um = 1e-6 * stiffness_N_m;
  m.screw_damping_Ns_m = 2.0 * e.damping_ratio * std::sqrt(stiffness_N_m * reduced_kg);
}

}  // namespace

void Apply(const AsymmetricCoulombExtension& e, const FrictionNumbers& f) {
  for (double* level : {f.Fc_plus, f.Fs_plus}) *level *= 1.0 + 0.5 * e.difference_rel;
  for (double* level : {f.Fc_minus, f.Fs_minus}) *level *= 1.0 - 0.5 * e.difference_rel;
}

void Apply(const StribeckExtension& e, const FrictionNumbers& f) {
  *f.Fs_plus = e.Fs_over_Fc * *f.Fc_plus;
  *f.Fs_minus = e.Fs_over_Fc * *f.Fc_minus;
  *f.vs = e.vs_rad_s * f.vs_per_rad_s;
}

void Apply(const TorqueConstantExtension& e, const FrictionNumbers& f,
           std::initializer_list<double*> beside) {
  for (double* value : {f.Fs_plus, f.Fs_minus, f.Fc_plus, f.Fc_minus, f.sigma0, f.sigma1, f.sigma2})
    *value /= e.ratio;
  for (double* value : beside) *value /= e.ratio;
}

ExtendedModel Extended(const ModelConfig& model) {
  ExtendedModel out{model.mechanics, model.friction};
  const ExtensionsConfig& e = model.extensions;
  const FrictionNumbers friction = NumbersOf(out.friction, ScrewRadius_m_rad(out.mechanics.lead_mm));
  if (e.asymmetric_coulomb) Apply(*e.asymmetric_coulomb, friction);
  if (e.stribeck) Apply(*e.stribeck, friction);
  if (e.compliance) Apply(*e.compliance, out.mechanics);
  MechanicsConfig& m = out.mechanics;
  if (e.torque_constant)
    Apply(*e.torque_constant, friction,
          {&m.motor_inertia_kgm2, &m.table_mass_kg, &m.screw_stiffness_N_um, &m.screw_damping_Ns_m});
  if (e.input_delay) out.added_delay_s = 1e-6 * e.input_delay->delay_us;
  if (e.current_lag) out.added_lag_s = 1e-6 * e.current_lag->time_constant_us;
  return out;
}

}  // namespace contour
