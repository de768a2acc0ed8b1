#include "tools/contour_gain/contour_gain.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/axis_model/scale_parameter.h"
#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/extensions_of.h"
#include "config/number_text.h"
#include "tools/machine/assigned_axis.h"
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
  for (const BaseParameter& p : found.base) {
    if (p.stated == 0.0 || !std::isfinite(p.fitted)) continue;
    const double factor = p.fitted / p.stated;
    if (!ScaleParameter(a, p.name, factor) && p.name == "lag") a.lag_s *= factor;
  }
  return a;
}

/// Causes as changes of the emulated machine, from the extensions they are.
EmulatedAxisConfig WithCauses(EmulatedAxisConfig axis, const ModelConfig& stated,
                              const ExtensionsConfig& all) {
  Assignments changes;
  for (const CauseDefinition* cause : AllCauses()) {
    const ExtensionRule* rule = cause->extension;
    if (rule == nullptr || rule->simulation == nullptr) continue;
    for (std::string& change : (*rule->simulation)(stated, all)) changes.push_back(std::move(change));
  }
  return Assigned(axis, changes);
}

/// What the stated numbers of a model have in them already.
ExtensionsConfig WithoutNumbers(ExtensionsConfig x) {
  for (const CauseDefinition* cause : AllCauses())
    if (cause->extension != nullptr && cause->extension->number_of_the_model) (*cause->extension->remove)(x);
  return x;
}

bool Simulated(const std::string& kind) {
  return CanExtend(kind) && CauseNamed(kind).extension->simulation != nullptr;
}

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
    e.temperature.start_degC = e.temperature.ambient_degC = temperature.farthest_degC;
    e = WithCauses(e, config.model, name == axis ? all : WithoutNumbers(config.model.extensions));
  }
  ContourGain gain;
  gain.program = program.name;
  gain.before_um = Peak_um(machine, emulator, program);
  gain.after_um = Peak_um(extended, emulator, program);
  return gain;
}

}  // namespace contour::diagnosis
