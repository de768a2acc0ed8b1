#include "tools/validation/family/family_machine.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "tools/validation/contest/machine_variant.h"

namespace contour {
namespace {

/// The rough plant's own numbers, as an independent plant behind the bus had them; what depends on the axis
/// is in its own units.
constexpr double kMotorFrictionShare = 0.3;
constexpr double kSideModeOfMode = 0.55;
constexpr double kSideModeMassShare = 0.12;
constexpr double kDeadTime_us = 60.0;
constexpr double kWobble_um = 0.3;

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

double Mode_Hz(const EmulatedAxisConfig& axis, double lead_mm) {
  const double radius_m = 1e-3 * lead_mm / (2.0 * std::numbers::pi);
  const double per_mass = radius_m * radius_m / axis.motor_inertia_kgm2 + 1.0 / axis.table_mass_kg;
  return std::sqrt(1e6 * axis.screw_stiffness_N_um * per_mass) / (2.0 * std::numbers::pi);
}

void AddRoughness(const MaybeEmulatedMachineFile& file, std::vector<std::string>& set) {
  for (const auto& [name, axis] : file.emulator.axes) {
    const double lead_mm = axis.lead_mm.value_or(file.machine.axes.at(name).model.mechanics.lead_mm);
    const std::string key = "emulator.axes." + name + ".";
    set.push_back(key + "friction.motor_share_rel=" + Number(kMotorFrictionShare));
    set.push_back(key + "side_modes=[{frequency_Hz: " + Number(kSideModeOfMode * Mode_Hz(axis, lead_mm)) +
                  ", mass_share_rel: " + Number(kSideModeMassShare) + "}]");
    set.push_back(key + "effects.input_delay={delay_us: " + Number(kDeadTime_us) + "}");
    set.push_back(key + "effects.pitch_error={amplitude_um: " + Number(kWobble_um) +
                  ", periods_per_stroke: " + Number(axis.stroke_mm / lead_mm) + "}");
  }
}

/// A loop that belongs to a machine's near models, as one line of YAML; empty when it has none.
std::string NearLoop(const std::string& folder, const std::string& machine, const std::string& which) {
  std::ifstream in(folder + "/near/" + machine + "_" + which + ".yaml");
  std::string line;
  while (std::getline(in, line))
    if (line.starts_with('{')) return line;
  return {};
}

}  // namespace

const std::vector<FamilyVariation>& FamilyVariations() {
  static const std::vector<FamilyVariation> all{
      {"k_minus_30", {"emulator.axes.*.screw_stiffness_N_um*=0.7"}},
      {"k_plus_30", {"emulator.axes.*.screw_stiffness_N_um*=1.3"}},
      {"table_minus_30", {"emulator.axes.*.table_mass_kg*=0.7"}},
      {"table_plus_30", {"emulator.axes.*.table_mass_kg*=1.3"}},
      {"masses_minus_30", {"emulator.axes.*.table_mass_kg*=0.7", "emulator.axes.*.motor_inertia_kgm2*=0.7"}},
      {"masses_plus_30", {"emulator.axes.*.table_mass_kg*=1.3", "emulator.axes.*.motor_inertia_kgm2*=1.3"}},
      {"friction_plus_50",
       {"emulator.axes.*.friction.Fs_plus_N*=1.5", "emulator.axes.*.friction.Fs_minus_N*=1.5",
        "emulator.axes.*.friction.Fc_plus_N*=1.5", "emulator.axes.*.friction.Fc_minus_N*=1.5"}},
      {"encoder_17bit", {"axes.*.drive.encoder_counts_per_rev=131072"}},
      {"delay_plus_1", {"emulator.axes.*.delay_cycles=2"}},
  };
  return all;
}

std::vector<std::string> FamilyMachines(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  if (names.empty()) throw ConfigError({folder + ": found no machine files (*.yaml)"});
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> FamilyAssignments(const std::string& folder, const FamilySetting& setting) {
  const std::string path = folder + "/" + setting.machine + ".yaml";
  const YamlValue tree = OpenMachineFile(path, {});
  const MaybeEmulatedMachineFile file = LoadMaybeEmulatedMachine(path);
  std::vector<std::string> wanted;
  if (setting.model == FamilyModel::kNear) {
    // The model is off by what it states and no more: the seed varies noise, phases and the start.
    wanted.push_back("emulator.parameter_variation_rel=0");
    for (const auto& [name, axis] : file.machine.axes) {
      wanted.push_back("axes." + name + ".model=near/" + setting.machine + "_" + name + ".yaml");
      for (const char* which : {"loop", "scale_loop"})
        if (const std::string loop = NearLoop(folder, setting.machine, which); !loop.empty())
          wanted.push_back("axes." + name + "." + which + "=" + loop);
    }
  }
  if (setting.plant == FamilyPlant::kRough) AddRoughness(file, wanted);
  if (setting.maxwell_slip) wanted.push_back("emulator.axes.*.friction.law=maxwell_slip");
  if (!setting.variation.empty()) {
    const auto& all = FamilyVariations();
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const FamilyVariation& v) { return v.name == setting.variation; });
    if (found == all.end()) {
      std::string known;
      for (const FamilyVariation& v : all) known += (known.empty() ? "" : ", ") + std::string(v.name);
      throw ConfigError({"--vary: found '" + setting.variation + "', expected some of " + known});
    }
    wanted.insert(wanted.end(), found->set.begin(), found->set.end());
  }
  wanted.insert(wanted.end(), setting.set.begin(), setting.set.end());
  return ExpandAssignments(tree, wanted);
}

double WindUp_m(const EmulatorConfig& emulator) {
  double sum_m = 0.0;
  for (const auto& [name, axis] : emulator.axes) {
    const EmulatedFrictionConfig& f = axis.friction;
    const double force_N = 0.25 * (f.Fs_plus_N + f.Fs_minus_N + f.Fc_plus_N + f.Fc_minus_N);
    sum_m += 1e-6 * force_N / axis.screw_stiffness_N_um;
  }
  return sum_m / static_cast<double>(emulator.axes.size());
}

}  // namespace contour
