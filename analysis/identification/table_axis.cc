#include "analysis/identification/table_axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/axis_model/seen_with_lever.h"

namespace contour::identify {

double Cogging_N(const TableAxis& axis, double motor_m) {
  double sum_N = 0.0;
  for (const MotorWave& w : axis.cogging) {
    if (w.order <= 0.0) continue;
    const double angle = w.order * 2.0 * std::numbers::pi * motor_m / axis.turn_m;
    sum_N += w.cosine_N * std::cos(angle) + w.sine_N * std::sin(angle);
  }
  return sum_N;
}

TableAxis FromStated(const diagnosis::StatedAxis& stated) {
  const double r = stated.linear ? 1.0 : (stated.table_per_q > 0.0 ? stated.table_per_q : 1.0);
  TableAxis axis;
  static_cast<diagnosis::AxisModel&>(axis) = diagnosis::SeenWithLever(diagnosis::ModelOf(stated), 1.0 / r);
  if (!axis.two_inertia) axis.load_inertia = axis.stiffness = axis.damping = 0.0;
  axis.radius_m_rad = r;
  axis.turn_m = stated.linear ? stated.lead_m : 2.0 * std::numbers::pi * r;
  return axis;
}

namespace {

CoggingWave WaveOf(const MotorWave& w, double radius_m_rad) {
  return {radius_m_rad * std::hypot(w.cosine_N, w.sine_N), w.order, std::atan2(w.cosine_N, w.sine_N)};
}

/// What goes with the motor's angle is an extension of the model, which the estimators feed forward. What was
/// stated stays where nothing was found.
void CoggingInto(const TableAxis& axis, ModelConfig& model) {
  if (axis.cogging.front().order <= 0.0) return;
  CoggingExtension found;
  static_cast<CoggingWave&>(found) = WaveOf(axis.cogging.front(), axis.radius_m_rad);
  for (std::size_t i = 1; i < axis.cogging.size(); ++i)
    if (axis.cogging[i].order > 0.0) found.further.push_back(WaveOf(axis.cogging[i], axis.radius_m_rad));
  model.extensions.cogging = found;
}

}  // namespace

void IntoConfig(const TableAxis& axis, ModelConfig& model) {
  const double r = axis.radius_m_rad;
  MechanicsConfig& m = model.mechanics;
  m.motor_inertia_kgm2 = axis.motor_inertia * r * r;
  m.table_mass_kg = axis.load_inertia;
  m.screw_stiffness_N_um = axis.stiffness * 1e-6;
  m.screw_damping_Ns_m = axis.damping;
  CoggingInto(axis, model);
  if (axis.two_inertia && axis.friction_on_load)
    model.friction.motor_share_rel = std::round(1e3 * axis.motor_friction_share) * 1e-3;
  if (axis.side.share > 0.0)
    model.side_modes = {{std::round(10.0 * axis.side.frequency_Hz) * 0.1,
                         std::round(1e3 * axis.side.share) * 1e-3,
                         std::clamp(std::round(1e4 * axis.side.damping_ratio) * 1e-4, 0.0, 1.0)}};
  const diagnosis::StatedFriction& f = axis.friction;
  FrictionConfig& c = model.friction;
  c.stribeck_exponent = f.exponent;
  if (c.acts_on == FrictionSide::kTable) {
    c.Fs_plus_N = f.Fs_plus;
    c.Fs_minus_N = f.Fs_minus;
    c.Fc_plus_N = f.Fc_plus;
    c.Fc_minus_N = f.Fc_minus;
    c.vs_mm_s = f.vs * 1e3;
    c.sigma0_N_m = f.s0;
    c.sigma1_Ns_m = f.s1;
    c.sigma1_decay_mm_s = f.vd * 1e3;
    c.sigma2_Ns_m = f.s2;
    return;
  }
  c.Fs_plus_Nm = f.Fs_plus * r;
  c.Fs_minus_Nm = f.Fs_minus * r;
  c.Fc_plus_Nm = f.Fc_plus * r;
  c.Fc_minus_Nm = f.Fc_minus * r;
  c.vs_rad_s = f.vs / r;
  c.sigma0_Nm_rad = f.s0 * r * r;
  c.sigma1_Nms_rad = f.s1 * r * r;
  c.sigma1_decay_rad_s = f.vd / r;
  c.sigma2_Nms_rad = f.s2 * r * r;
}

}  // namespace contour::identify
