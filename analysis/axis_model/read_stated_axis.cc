#include "analysis/axis_model/read_stated_axis.h"

#include <numbers>
#include <string_view>
#include <utility>

#include "analysis/axis_model/apply_extensions.h"
#include "analysis/axis_model/extension_keys.h"
#include "analysis/axis_model/loose_axis.h"
#include "analysis/axis_model/stated_parameters.h"
#include "config/config_error.h"
#include "config/extended_model.h"
#include "config/load_machine.h"
#include "config/yaml_reader.h"

namespace contour::diagnosis {
namespace {

std::string OneAxis(const MachineConfig& machine, const std::string& file, const std::string& axis) {
  std::string all;
  for (const auto& [name, config] : machine.axes) all += (all.empty() ? "" : ", ") + name;
  if (axis.empty()) {
    if (machine.axes.size() == 1) return machine.axes.begin()->first;
    throw ConfigError({file + ": holds the axes " + all + "; say by --axis which one"});
  }
  if (!machine.axes.contains(axis))
    throw ConfigError({"--axis: found '" + axis + "', but " + file + " holds " + all});
  return axis;
}

StatedFriction AtTable(const Friction& f) {
  return {f.Fc_plus_N,         f.Fc_minus_N, f.Fs_plus_N,   f.Fs_minus_N,       f.vs_m_s,
          f.stribeck_exponent, f.sigma0_N_m, f.sigma1_Ns_m, f.sigma1_decay_m_s, f.sigma2_Ns_m};
}

bool IsMachine(const YamlValue& tree) { return tree.Find("axes") != nullptr; }

/// Motor values (Nm, rad) say on which side friction acts.
void SayActsOn(YamlValue& model) {
  YamlEntry* friction = model.Find("friction");
  if (friction == nullptr || friction->value.Find("acts_on") != nullptr) return;
  for (const YamlEntry& e : friction->value.entries) {
    if (e.key.find("_Nm") == std::string::npos && e.key.find("_rad") == std::string::npos) continue;
    YamlValue motor;
    motor.kind = YamlValue::Kind::kScalar;
    motor.text = "motor";
    motor.where = e.where;
    friction->value.entries.push_back({"acts_on", e.where, motor});
    return;
  }
}

/// What a spring between two masses is called on a linear axis, whatever unit was thought of.
void DemandKeysOfLinearAxes(YamlValue& model, std::vector<std::string>& errors) {
  static constexpr std::pair<std::string_view, std::string_view> kKeys[] = {
      {"stiffness_", "screw_stiffness_N_um, in N/um"}, {"damping_", "screw_damping_Ns_m, in N s/m"}};
  std::erase_if(model.entries, [&](const YamlEntry& e) {
    for (const auto& [begin, expected] : kKeys) {
      if (!e.key.starts_with(begin)) continue;
      errors.push_back(e.where + ": " + e.key + ": found on a linear axis, expected " +
                       std::string(expected));
      return true;
    }
    return false;
  });
}

StatedAxis ReadLoose(YamlValue tree) {
  LooseAxisFile content = ReadLooseFile(tree);
  std::vector<std::string> errors;
  const StatedAxis axis = ToStatedAxis(content, tree, tree.Find("model") != nullptr ? "model" : "", errors);
  if (!errors.empty()) throw ConfigError(std::move(errors));
  return axis;
}

}  // namespace

LooseAxisFile ReadLooseFile(YamlValue& tree) {
  std::vector<std::string> errors;
  LooseAxisFile content;
  const bool has_model_key = tree.Find("model") != nullptr;
  YamlValue& model = has_model_key ? tree.Find("model")->value : tree;
  const ExtensionUnits units = UnitsOf(model);
  SayActsOn(model);
  if (units == ExtensionUnits::kOfLinearAxis) DemandKeysOfLinearAxes(model, errors);
  if (YamlEntry* extensions = model.Find("extensions")) RenameFromFile(units, extensions->value);
  if (has_model_key)
    ReadYaml(tree, content, "", errors);
  else
    ReadYaml(tree, content.model, "", errors);
  for (std::string& e : errors) e = RenamedToFile(units, e);
  if (!errors.empty()) throw ConfigError(std::move(errors));
  return content;
}

bool IsMachineFile(const std::string& file) { return IsMachine(ParseYamlFile(file)); }

StatedAxis ToStatedAxis(const MachineConfig& machine, const std::string& name) {
  const AxisConfig& a = machine.axes.at(name);
  const ExtendedModel model = Extended(a.model);
  const Mechanics m = ToSi(model.mechanics);
  const double r = m.radius_m_rad;
  StatedAxis axis;
  axis.axis = name;
  axis.lead_m = a.model.mechanics.lead_mm * 1e-3;
  axis.table_per_q = r;
  axis.two_inertia = true;
  axis.motor_inertia = model.mechanics.motor_inertia_kgm2;
  axis.load_inertia = r * r * m.table_mass_kg;
  axis.stiffness = r * r * m.stiffness_N_m;
  axis.damping = r * r * m.damping_Ns_m;
  axis.friction_on_load = a.model.friction.acts_on == FrictionSide::kTable;
  axis.motor_share = a.model.friction.motor_share_rel;
  axis.friction = SeenAtQ(AtTable(ToSi(model.friction, r)), r);
  axis.delay_s = a.drive.delay_cycles * machine.machine.cycle_us * 1e-6 + model.added_delay_s;
  axis.lag_s = a.drive.lag_ms * 1e-3 + model.added_lag_s;
  ApplyExtras(a.model.extensions, axis);  // those that are numbers are in Extended() already
  axis.position_step = 2.0 * std::numbers::pi / a.drive.encoder_counts_per_rev;
  axis.command_step = a.drive.rated_torque_Nm * 1e-3;  // the bus carries per mille of it
  axis.rated = a.drive.rated_torque_Nm;
  axis.stroke_min_m = a.limits.position_mm[0] * 1e-3;
  axis.stroke_max_m = a.limits.position_mm[1] * 1e-3;
  axis.sigma = EngineSigmas(a.model.uncertainty);
  SetInertiaSigma(axis, Find(a.model.uncertainty, "motor_inertia_kgm2"),
                  Find(a.model.uncertainty, "table_mass_kg"), axis.motor_inertia, axis.load_inertia);
  return axis;
}

StatedAxis ReadStatedAxis(const std::string& file, const std::string& axis,
                          const std::vector<std::string>& overrides) {
  StatedAxis stated;
  YamlValue tree = ParseYamlFile(file);
  if (IsMachine(tree)) {
    const MachineConfig machine = LoadMachine(file, overrides);
    stated = ToStatedAxis(machine, OneAxis(machine, file, axis));
  } else {
    for (const std::string& assignment : overrides) ApplyOverride(tree, assignment);
    stated = ReadLoose(tree);
    stated.axis = axis;
  }
  stated.source = file;
  return stated;
}

}  // namespace contour::diagnosis
