#include "tools/validation/commissioning/commissioning_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/identification/result_files.h"
#include "analysis/identification/usable.h"
#include "analysis/text/format_text.h"
#include "config/config_error.h"

namespace contour {
namespace {

constexpr double kMotorFrictionShare = 0.3;
constexpr double kSideModeOfMode = 0.55;
constexpr double kSideModeMassShare = 0.12;
constexpr double kWobble_um = 0.3;
constexpr double kRipple = 0.02;
constexpr double kTorqueNoise = 0.005;
constexpr double kRatedOfCogging_Nm = 0.637;
/// What carries a vertical axis: a mass that moves along, of the table's, and a force that the weight leaves,
/// of friction.
constexpr double kMovedAlong = 0.9, kCarried = 1.0, kRate_N_mm = 0.2;

double Mode_Hz(const EmulatedAxisConfig& axis, double lead_mm) {
  const double radius_m = 1e-3 * lead_mm / (2.0 * std::numbers::pi);
  const double per_mass = radius_m * radius_m / axis.motor_inertia_kgm2 + 1.0 / axis.table_mass_kg;
  return std::sqrt(1e6 * axis.screw_stiffness_N_um * per_mass) / (2.0 * std::numbers::pi);
}

std::string Cogging(const AxisConfig& axis, double of_small_motor_Nm, std::uint64_t seed) {
  // Poles and slots as the seed draws them.
  constexpr int kOrders[] = {12, 6, 18, 24, 10};
  return FormatText("effects.cogging={amplitude_Nm: %.6g, order_per_rev: %d, phase_rad: %.4g}",
                    of_small_motor_Nm * axis.drive.rated_torque_Nm / kRatedOfCogging_Nm, kOrders[seed % 5],
                    std::fmod(2.4 * static_cast<double>(seed), 6.28));
}

std::vector<std::string> Assignments(const EmulatedMachineFile& file, const CommissioningCase& c) {
  std::vector<std::string> set{"emulator.seed=" + std::to_string(c.seed)};
  for (const auto& [name, axis] : file.emulator.axes) {
    const AxisConfig& config = file.machine.axes.at(name);
    const double lead_mm = axis.lead_mm.value_or(config.model.mechanics.lead_mm);
    set.push_back("axes." + name + ".drive.mode=" + c.mode);
    const std::string key = "emulator.axes." + name + ".";
    if (c.effect == "cogging3") set.push_back(key + Cogging(config, 3e-3, c.seed));
    if (c.effect == "cogging6") set.push_back(key + Cogging(config, 6e-3, c.seed));
    if (c.effect == "ripple")
      set.push_back(key + FormatText("effects.torque_ripple={amplitude_rel: %g, order_per_rev: 6}", kRipple));
    if (c.effect == "wobble")
      set.push_back(key + FormatText("effects.pitch_error={amplitude_um: %g, periods_per_stroke: %.6g}",
                                     kWobble_um, axis.stroke_mm / lead_mm));
    if (c.effect == "torque_noise")
      set.push_back(key + FormatText("torque_noise_Nm=%.6g", kTorqueNoise * config.drive.rated_torque_Nm));
    if (c.effect == "counterbalance")
      set.push_back(key + FormatText("counterbalance={moving_mass_kg: %.6g, force_N: %.6g, rate_N_mm: %g}",
                                     kMovedAlong * axis.table_mass_kg, kCarried * axis.friction.Fc_plus_N,
                                     kRate_N_mm));
    if (c.effect == "motor_friction")
      set.push_back(key + FormatText("friction.motor_share_rel=%g", kMotorFrictionShare));
    if (c.effect == "side_mode")
      set.push_back(key + FormatText("side_modes=[{frequency_Hz: %.6g, mass_share_rel: %g}]",
                                     kSideModeOfMode * Mode_Hz(axis, lead_mm), kSideModeMassShare));
  }
  set.insert(set.end(), c.set.begin(), c.set.end());
  return set;
}

}  // namespace

const std::vector<std::string>& CommissioningEffects() {
  static const std::vector<std::string> all{"none",      "cogging3",       "cogging6",
                                            "ripple",    "wobble",         "motor_friction",
                                            "side_mode", "counterbalance", "torque_noise"};
  return all;
}

EmulatedMachineFile MachineOf(const CommissioningCase& c, KnownLoops& known) {
  const auto& effects = CommissioningEffects();
  if (std::find(effects.begin(), effects.end(), c.effect) == effects.end())
    throw ConfigError({"--effects: there is no effect \"" + c.effect + "\""});
  const std::string path = std::string(CONTOUR_CONFIG_DIR) +
                           (c.machine == "base" ? "/xy_emulated.yaml" : "/family/" + c.machine + ".yaml");
  EmulatedMachineFile file = LoadEmulatedMachine(path, Assignments(LoadEmulatedMachine(path), c));
  StateCatalogue(file, c.seed, known);
  return file;
}

namespace {

/// What a machine in torque mode begins with: what it lacks was searched when its file was made.
TorqueLoops LoopsOf(const MachineConfig& machine) {
  TorqueLoops own;
  for (const auto& [name, axis] : machine.axes) {
    if (axis.loop) own.loops[name] = *axis.loop;
    if (!axis.loop) own.lacking.push_back(name);
  }
  return own;
}

TorqueLoops LoopsFromCatalogue(const EmulatedMachineFile& file, const CommissioningCase& c,
                               KnownTorqueLoops& known) {
  if (c.mode == "cst") return LoopsOf(file.machine);
  const EmulatedAxisConfig& axis = file.emulator.axes.at(c.axis);
  const double moving_kg = axis.counterbalance ? axis.counterbalance->moving_mass_kg : 0.0;
  const std::string key = FormatText("%s %llu %g", file.machine.machine.name.c_str(),
                                     static_cast<unsigned long long>(c.seed), moving_kg);
  if (!known.contains(key)) known[key] = FindTorqueLoops(file.machine, 1);
  return known.at(key);
}

}  // namespace

Recorded AsRecorded(const EmulatedMachineFile& file, const CommissioningCase& c, KnownTorqueLoops& known) {
  Recorded recorded{file, c.stay ? "csp" : c.mode};
  recorded.file.machine = InCsp(file.machine);
  const EmulatedMachineFile in_csp = recorded.file;
  if (c.stay) return recorded;
  TorqueLoops torque = LoopsFromCatalogue(file, c, known);
  if (c.mode == "cst" && torque.lacking.empty()) return {file, c.mode};
  MachineConfig better = file.machine;
  for (const std::string& name : torque.lacking) {
    recorded.how += ", " + name + " first" + (c.mode == "csp" ? "" : " in csp");
    const VirtualCommissioning run = Commission(in_csp, name, "full");
    const identify::Identification id =
        identify::Identify(diagnosis::ToStatedAxis(in_csp.machine, name), {run.log}, {});
    const std::string why = identify::WhyNoBeginning(id);
    if (why.empty()) better.axes.at(name).model = identify::ToModel(id, better.axes.at(name).model);
    if (!why.empty()) recorded.how += " (in vain: " + why + ")";
  }
  if (!torque.lacking.empty()) torque = FindTorqueLoops(better, 1, torque.loops);
  if (torque.complete()) {
    recorded.file.machine = InTorqueMode(better, torque.loops);
    recorded.how += ", then cst";
  } else {
    recorded.how += ", then csp: " + torque.why_not;
  }
  return recorded;
}

}  // namespace contour
