#include "tools/machine/stated_machine.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "config/extended_model.h"
#include "config/loop_axis.h"
#include "core/mechanics.h"

namespace contour {
namespace {

/// Of the motor that is told of its torque by the constant that the file states.
CoggingTerm Emulated(const CoggingWave& wave, double ratio) {
  CoggingTerm term;
  term.amplitude_Nm = wave.amplitude_Nm / ratio;
  term.order_per_rev = wave.order_per_rev;
  term.phase_rad = wave.phase_rad;
  return term;
}

/// What a controller leads along the path would swing a machine that has it not.
std::optional<CoggingEffect> CoggingOf(const ExtensionsConfig& c) {
  if (!c.cogging) return std::nullopt;
  const double ratio = c.torque_constant ? c.torque_constant->ratio : 1.0;
  CoggingEffect out{Emulated(*c.cogging, ratio), {}};
  for (const CoggingWave& wave : c.cogging->further) out.further.push_back(Emulated(wave, ratio));
  return out;
}

EmulatedAxisConfig StatedAxis(const AxisConfig& axis, const OffStated& off) {
  const ExtendedModel model = Extended(axis.model);
  const Friction f = ToSi(model.friction, ToSi(model.mechanics).radius_m_rad);
  const LoopAxis known = LoopAxisOf(axis);
  const double inertia = std::pow(1.0 + std::max(known.motor_mass_std, known.table_mass_std), off.inertia);
  EmulatedAxisConfig e;
  e.motor_inertia_kgm2 = inertia * model.mechanics.motor_inertia_kgm2;
  e.table_mass_kg = inertia * model.mechanics.table_mass_kg;
  e.screw_stiffness_N_um =
      std::pow(1.0 + known.stiffness_std, off.stiffness) * model.mechanics.screw_stiffness_N_um;
  e.screw_damping_Ns_m = model.mechanics.screw_damping_Ns_m;
  // The emulated axis has its bumpers as far below zero as above, the stated one its limits anywhere.
  const auto [low_mm, high_mm] = axis.limits.position_mm;
  e.stroke_mm = 2.0 * std::max(std::abs(low_mm), std::abs(high_mm));
  e.start_position_mm = 0.5 * (low_mm + high_mm);
  e.start_variation_mm = 0.0;
  e.incremental_encoder = !axis.drive.absolute_encoder;
  e.delay_cycles = axis.drive.delay_cycles;
  e.lag_ms = axis.drive.lag_ms + 1e3 * model.added_lag_s;
  EmulatedFrictionConfig& g = e.friction;
  g.stribeck_exponent = f.stribeck_exponent >= 1.5 ? 2 : 1;  // what it can be
  g.Fc_plus_N = f.Fc_plus_N;
  g.Fc_minus_N = f.Fc_minus_N;
  g.Fs_plus_N = f.Fs_plus_N;
  g.Fs_minus_N = f.Fs_minus_N;
  g.vs_mm_s = 1e3 * f.vs_m_s;
  g.sigma0_N_m = f.sigma0_N_m;
  g.sigma1_Ns_m = f.sigma1_Ns_m;
  g.sigma1_decay_mm_s = 1e3 * f.sigma1_decay_m_s;
  g.sigma2_Ns_m = f.sigma2_Ns_m;
  g.motor_share_rel = f.motor_share;
  g.position_amplitude_rel = 0.0;
  g.ripple_amplitude_rel = 0.0;
  e.effects.cogging = CoggingOf(axis.model.extensions);
  for (const SideMode& mode : axis.model.side_modes)
    e.side_modes.push_back({mode.frequency_Hz, mode.mass_share_rel, mode.damping_ratio});
  return e;
}

}  // namespace

EmulatorConfig StatedMachine(const MachineConfig& machine, const OffStated& off) {
  EmulatorConfig emulator;
  emulator.parameter_variation_rel = 0.0;
  for (const auto& [name, axis] : machine.axes) emulator.axes[name] = StatedAxis(axis, off);
  return emulator;
}

}  // namespace contour
