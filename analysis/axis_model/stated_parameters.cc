#include "analysis/axis_model/stated_parameters.h"

#include <algorithm>
#include <cmath>

namespace contour::diagnosis {
namespace {

/// Keys of the files, and what the engine calls them; inertias have no one name.
const std::map<std::string, std::string>& NamesOfKeys() {
  static const std::map<std::string, std::string> names = {{"motor_inertia_kgm2", ""},
                                                           {"table_mass_kg", ""},
                                                           {"load_inertia_kgm2", ""},
                                                           {"mass_kg", ""},
                                                           {"load_mass_kg", ""},
                                                           {"lead_mm", ""},
                                                           {"stribeck_exponent", ""},
                                                           {"motor_share_rel", ""},
                                                           {"sigma1_decay_mm_s", ""},
                                                           {"sigma1_decay_rad_s", ""},
                                                           {"screw_stiffness_N_um", "stiffness"},
                                                           {"stiffness_Nm_rad", "stiffness"},
                                                           {"screw_damping_Ns_m", "damping"},
                                                           {"damping_Nms_rad", "damping"},
                                                           {"Fc_plus_N", "Fc"},
                                                           {"Fc_minus_N", "Fc"},
                                                           {"Fc_plus_Nm", "Fc"},
                                                           {"Fc_minus_Nm", "Fc"},
                                                           {"Fs_plus_N", "Fs"},
                                                           {"Fs_minus_N", "Fs"},
                                                           {"Fs_plus_Nm", "Fs"},
                                                           {"Fs_minus_Nm", "Fs"},
                                                           {"vs_mm_s", "vs"},
                                                           {"vs_rad_s", "vs"},
                                                           {"sigma0_N_m", "s0"},
                                                           {"sigma0_Nm_rad", "s0"},
                                                           {"sigma1_Ns_m", "s1"},
                                                           {"sigma1_Nms_rad", "s1"},
                                                           {"sigma2_Ns_m", "s2"},
                                                           {"sigma2_Nms_rad", "s2"},
                                                           {"constant_force_N", "offset"},
                                                           {"constant_torque_Nm", "offset"},
                                                           {"delay_ms", "delay"},
                                                           {"lag_ms", "lag"},
                                                           {"torque_constant", "torque_constant"}};
  return names;
}

}  // namespace

StatedFriction SeenAtQ(StatedFriction f, double lever) {
  for (double* level : {&f.Fc_plus, &f.Fc_minus, &f.Fs_plus, &f.Fs_minus}) *level *= lever;
  for (double* speed : {&f.vs, &f.vd}) *speed /= lever;
  for (double* slope : {&f.s0, &f.s1, &f.s2}) *slope *= lever * lever;
  return f;
}

std::map<std::string, double> EngineSigmas(const std::map<std::string, double>& uncertainty) {
  std::map<std::string, double> sigma;
  for (const auto& [key, value] : uncertainty) {
    const auto name = NamesOfKeys().find(key);
    if (name != NamesOfKeys().end() && !name->second.empty())
      sigma[name->second] = std::max(sigma[name->second], value);
  }
  return sigma;
}

bool IsUncertaintyKey(const std::string& key) { return NamesOfKeys().contains(key); }

void SetInertiaSigma(StatedAxis& axis, std::optional<double> motor, std::optional<double> load,
                     double motor_part, double load_part) {
  if (axis.two_inertia) {
    if (motor) axis.sigma["inertia"] = *motor;
    if (load) axis.sigma["load_inertia"] = *load;
  } else if (motor || load) {
    axis.sigma["inertia"] = std::hypot(motor.value_or(0.0) * motor_part, load.value_or(0.0) * load_part) /
                            (motor_part + load_part);
  }
}

std::optional<double> Find(const std::map<std::string, double>& map, const std::string& key) {
  const auto at = map.find(key);
  if (at == map.end()) return {};
  return at->second;
}

}  // namespace contour::diagnosis
