#include "tools/contour_gain/contour_gain.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/diagnosis/causes/extensions_of.h"
#include "config/extended_model.h"
#include "config/number_text.h"
#include "tools/validation/contest/contest_cell.h"

namespace contour::diagnosis {
namespace {

/// The emulated axis that is exactly what a stated one says. q is the motor's angle.
EmulatedAxisConfig Emulated(const StatedAxis& a, const AxisConfig& config) {
  const double r = a.table_per_q;
  EmulatedAxisConfig e;
  e.motor_inertia_kgm2 = a.motor_inertia;
  e.table_mass_kg = a.load_inertia / (r * r);
  e.screw_stiffness_N_um = 1e-6 * a.stiffness / (r * r);
  e.screw_damping_Ns_m = a.damping / (r * r);
  e.stroke_mm = config.limits.position_mm[1] - config.limits.position_mm[0];
  e.start_position_mm = 0.0;
  e.start_variation_mm = 0.0;
  e.delay_cycles = config.drive.delay_cycles;
  e.lag_ms = 1e3 * a.lag_s;
  const StatedFriction& f = a.friction;
  EmulatedFrictionConfig& g = e.friction;
  g.stribeck_exponent = f.exponent >= 1.5 ? 2 : 1;
  g.Fc_plus_N = f.Fc_plus / r;
  g.Fc_minus_N = f.Fc_minus / r;
  g.Fs_plus_N = std::max(f.Fs_plus, f.Fc_plus) / r;
  g.Fs_minus_N = std::max(f.Fs_minus, f.Fc_minus) / r;
  g.vs_mm_s = 1e3 * f.vs * r;
  g.sigma0_N_m = f.s0 / (r * r);
  g.sigma1_Ns_m = f.s1 / (r * r);
  g.sigma1_decay_mm_s = 1e3 * f.vd * r;
  g.sigma2_Ns_m = f.s2 / (r * r);
  g.position_amplitude_rel = 0.0;
  g.ripple_amplitude_rel = 0.0;
  return e;
}

/// The stated axis with its numbers as fitted.
StatedAxis Fitted(StatedAxis a, const Diagnosis& found) {
  const auto scale = [&](const char* name, std::initializer_list<double*> values) {
    for (const BaseParameter& p : found.base)
      if (p.name == name && p.stated != 0.0 && std::isfinite(p.fitted))
        for (double* value : values) *value *= p.fitted / p.stated;
  };
  StatedFriction& f = a.friction;
  scale("inertia", {&a.motor_inertia});
  scale("load_inertia", {&a.load_inertia});
  scale("stiffness", {&a.stiffness});
  scale("damping", {&a.damping});
  scale("Fc", {&f.Fc_plus, &f.Fc_minus});
  scale("Fs", {&f.Fs_plus, &f.Fs_minus});
  scale("vs", {&f.vs});
  scale("s0", {&f.s0});
  scale("s1", {&f.s1});
  scale("s2", {&f.s2});
  scale("lag", {&a.lag_s});
  return a;
}

RippleEffect Ripple(const RippleExtension& r) {
  RippleEffect e = {{r.amplitude_rel, r.order_per_rev, r.phase_rad}, {}};
  for (const RippleWave& w : r.further) e.further.push_back({w.amplitude_rel, w.order_per_rev, w.phase_rad});
  return e;
}

CoggingEffect Cogging(const CoggingExtension& c) {
  CoggingEffect e = {{c.amplitude_Nm, c.order_per_rev, c.phase_rad}, {}};
  for (const CoggingWave& w : c.further) e.further.push_back({w.amplitude_Nm, w.order_per_rev, w.phase_rad});
  return e;
}

ViscousTerm Curve(const ViscousCurve& c) {
  return {c.torque_at_max_speed_Nm, c.max_speed_rad_s, std::clamp(c.exponent, 1.0, 4.0), c.knee_rad_s};
}

ViscousNonlinearEffect Viscous(const ViscousNonlinearExtension& x) {
  ViscousNonlinearEffect e = {Curve(x), {}};
  for (const ViscousCurve& c : x.further) e.further.push_back(Curve(c));
  return e;
}

/// Causes as effects of the emulated machine, from the extensions they are.
EffectsConfig Effects(const ExtensionsConfig& x) {
  EffectsConfig e;
  if (x.asymmetric_coulomb)
    e.asymmetric_coulomb = AsymmetricCoulombEffect{x.asymmetric_coulomb->difference_rel};
  if (x.constant_torque) e.constant_torque = ConstantTorqueEffect{x.constant_torque->torque_Nm};
  if (x.stribeck) e.stribeck = StribeckEffect{x.stribeck->Fs_over_Fc, x.stribeck->vs_rad_s};
  if (x.position_friction)
    e.friction_map = FrictionMapEffect{x.position_friction->position_mm, x.position_friction->friction_rel};
  if (x.friction_ripple) e.friction_ripple = Ripple(*x.friction_ripple);
  if (x.ball_ripple) e.ball_ripple = Ripple(*x.ball_ripple);
  if (x.cogging) e.cogging = Cogging(*x.cogging);
  if (x.viscous_nonlinear) e.viscous_nonlinear = Viscous(*x.viscous_nonlinear);
  if (x.temperature_viscosity)
    e.temperature_viscosity = TemperatureViscosityEffect{x.temperature_viscosity->rate_1_K};
  if (x.torque_constant) e.torque_constant = TorqueConstantEffect{x.torque_constant->ratio};
  if (x.input_delay) e.input_delay = InputDelayEffect{std::max(0.0, x.input_delay->delay_us)};
  if (x.current_lag) e.current_lag = CurrentLagEffect{std::max(0.0, x.current_lag->time_constant_us)};
  if (x.pitch_error) e.pitch_map = PitchMapEffect{x.pitch_error->position_mm, x.pitch_error->error_um};
  return e;
}

/// What the stated numbers of a model have in them already.
ExtensionsConfig WithoutNumbers(ExtensionsConfig x) {
  x.asymmetric_coulomb.reset();
  x.stribeck.reset();
  x.torque_constant.reset();
  x.compliance.reset();
  x.input_delay.reset();
  x.current_lag.reset();
  return x;
}

/// Kinds that Effects() knows, and stiffness, which is in the fitted numbers.
bool Simulated(const std::string& kind) { return CanExtend(kind) && kind != "cable_spring"; }

double Peak_um(const MachineConfig& machine, const EmulatorConfig& emulator, const Program& program) {
  ContestCell cell;
  cell.program = program;
  cell.program_name = program.name;
  cell.machine = std::make_shared<EmulatedMachineFile>(EmulatedMachineFile{machine, emulator});
  const CellResult result = RunCell(cell);
  if (result.failed()) throw std::runtime_error("simulating " + program.name + ": " + result.failure);
  return result.peak_um;
}

}  // namespace

Program UsualCircle(const MachineConfig& machine) {
  double velocity_mm_s = 50.0;
  double radius_mm = 10.0;
  for (const auto& [name, axis] : machine.axes) {
    velocity_mm_s = std::min(velocity_mm_s, 0.5 * axis.limits.velocity_mm_s);
    radius_mm = std::min(radius_mm, 0.2 * std::min(-axis.limits.position_mm[0], axis.limits.position_mm[1]));
  }
  radius_mm = std::max(radius_mm, 0.1);
  return ParseProgram(
      "{shape: circle, radius_mm: " + NumberText(radius_mm) +
          ", feed_mm_min: " + NumberText(60.0 * velocity_mm_s) + ", turns: 4}",
      "a circle of " + RoundedText(radius_mm) + " mm at " + RoundedText(0.06 * velocity_mm_s) + " m/min",
      ProgramFormat::kYaml);
}

std::optional<ContourGain> PredictContourGain(const MachineConfig& machine, const std::string& axis,
                                              const Diagnosis& found, const LogTemperature& temperature,
                                              const Program& program) {
  std::vector<Cause> simulated;
  for (const Cause& c : found.causes)
    if (Simulated(c.kind)) simulated.push_back(c);
  if (machine.axes.size() < 2 || simulated.empty()) return {};
  MachineConfig extended = machine;
  ExtensionsConfig& known = extended.axes.at(axis).model.extensions;
  ExtensionsConfig all = WithoutNumbers(known);
  AddCauses(simulated, temperature.first_degC, all);
  AddCauses(simulated, temperature.first_degC, known);
  EmulatorConfig emulator;
  emulator.parameter_variation_rel = 0.0;
  for (const auto& [name, config] : machine.axes) {
    const StatedAxis stated = ToStatedAxis(machine, name);
    EmulatedAxisConfig& e = emulator.axes[name];
    e = Emulated(name == axis ? Fitted(stated, found) : stated, config);
    const ExtensionsConfig there = name == axis ? all : WithoutNumbers(config.model.extensions);
    e.effects = Effects(there);
    e.temperature.start_degC = e.temperature.ambient_degC = temperature.farthest_degC;
    if (there.temperature_viscosity)
      e.temperature.reference_degC = there.temperature_viscosity->reference_degC;
  }
  EmulatedAxisConfig& diagnosed = emulator.axes.at(axis);
  if (all.compliance) {
    ModelConfig with = machine.axes.at(axis).model;
    with.extensions.compliance = all.compliance;
    diagnosed.screw_stiffness_N_um = Extended(with).mechanics.screw_stiffness_N_um;
    diagnosed.screw_damping_Ns_m = Extended(with).mechanics.screw_damping_Ns_m;
  }
  ContourGain gain;
  gain.program = program.name;
  gain.before_um = Peak_um(machine, emulator, program);
  gain.after_um = Peak_um(extended, emulator, program);
  return gain;
}

}  // namespace contour::diagnosis
