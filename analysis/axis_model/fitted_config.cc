#include "analysis/axis_model/fitted_config.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <sstream>
#include <string_view>

#include "analysis/axis_model/stated_parameters.h"
#include "config/yaml_writer.h"

namespace contour::diagnosis {
namespace {

using Deviations = std::map<std::string, double>;

/// The reader refuses more.
constexpr double kMostUncertain = 10.0;

/// A deviation under each of the keys that the engine's name stands for.
class Uncertainty {
 public:
  Uncertainty(const StatedAxis& axis, Deviations& to) : axis_(axis), to_(to) {}
  void Put(const char* name, std::initializer_list<const char*> keys, double factor = 1.0) {
    const auto at = axis_.sigma.find(name);
    if (at == axis_.sigma.end()) return;
    for (const char* key : keys) to_[key] = FiveDigits(std::min(kMostUncertain, factor * at->second));
  }
  void PutFriction(bool at_table) {
    Put("Fc", {at_table ? "Fc_plus_N" : "Fc_plus_Nm", at_table ? "Fc_minus_N" : "Fc_minus_Nm"});
    Put("Fs", {at_table ? "Fs_plus_N" : "Fs_plus_Nm", at_table ? "Fs_minus_N" : "Fs_minus_Nm"});
    Put("vs", {at_table ? "vs_mm_s" : "vs_rad_s"});
    Put("s0", {at_table ? "sigma0_N_m" : "sigma0_Nm_rad"});
    Put("s1", {at_table ? "sigma1_Ns_m" : "sigma1_Nms_rad"});
    Put("s2", {at_table ? "sigma2_Ns_m" : "sigma2_Nms_rad"});
  }

 private:
  const StatedAxis& axis_;
  Deviations& to_;
};

/// Two inertias that are one of a rigid axis keep their shares; so much more deviates each than their sum.
struct Shares {
  double motor = 1.0, load = 0.0, widen = 1.0;
};
Shares SharesOf(double motor, double load) {
  const double sum = motor + load;
  return {motor / sum, load / sum, load > 0.0 ? sum / std::hypot(motor, load) : 1.0};
}

void IntoFriction(const StatedAxis& axis, double lever, LooseFrictionConfig& c) {
  const bool at_table = axis.linear || c.acts_on == FrictionSide::kTable;
  const StatedFriction f = at_table && !axis.linear ? SeenAtQ(axis.friction, 1.0 / lever) : axis.friction;
  const double speed_unit = at_table ? 1e3 : 1.0;
  if (f.exponent != c.stribeck_exponent.value_or(1.0)) c.stribeck_exponent = f.exponent;
  c.Fc_plus = FiveDigits(f.Fc_plus);
  c.Fc_minus = FiveDigits(f.Fc_minus);
  c.Fs_plus = FiveDigits(f.Fs_plus);
  c.Fs_minus = FiveDigits(f.Fs_minus);
  c.vs = FiveDigits(f.vs * speed_unit);
  c.sigma0 = FiveDigits(f.s0);
  c.sigma1 = FiveDigits(f.s1);
  c.sigma1_decay = FiveDigits(f.vd * speed_unit);
  c.sigma2 = FiveDigits(f.s2);
}

bool StatesNothing(std::string_view line) {
  static constexpr std::string_view kKeys[] = {"table_mass_kg: 0",
                                               "screw_damping_Ns_m: 0",
                                               "damping_Nms_rad: 0",
                                               "constant_torque_Nm: 0",
                                               "constant_force_N: 0",
                                               "gear_ratio: 1",
                                               "motor_share_rel: 0",
                                               "delay_ms: 0",
                                               "lag_ms: 0",
                                               "encoder_counts_per_rev: 0",
                                               "position_step_um: 0",
                                               "torque_step_Nm: 0",
                                               "force_step_N: 0",
                                               "rated_torque_Nm: 0",
                                               "rated_force_N: 0",
                                               "torque_constant_Nm_A: 0",
                                               "force_constant_N_A: 0",
                                               "extensions: {}",
                                               "uncertainty: {}"};
  line.remove_prefix(std::min(line.size(), line.find_first_not_of(' ')));
  return std::find(std::begin(kKeys), std::end(kKeys), line) != std::end(kKeys);
}

}  // namespace

double FiveDigits(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, 4.0 - std::floor(std::log10(std::fabs(value))));
  return std::round(value * scale) / scale;
}

void IntoConfig(const StatedAxis& axis, ModelConfig& config) {
  const double r = axis.table_per_q;
  MechanicsConfig& m = config.mechanics;
  m.motor_inertia_kgm2 = FiveDigits(axis.motor_inertia);
  m.table_mass_kg = FiveDigits(axis.load_inertia / (r * r));
  m.screw_stiffness_N_um = FiveDigits(1e-6 * axis.stiffness / (r * r));
  m.screw_damping_Ns_m = FiveDigits(axis.damping / (r * r));
  FrictionConfig& c = config.friction;
  const bool at_table = c.acts_on == FrictionSide::kTable;
  const StatedFriction f = at_table ? SeenAtQ(axis.friction, 1.0 / r) : axis.friction;
  const auto put = [&](double value, double& table, double& motor) {
    (at_table ? table : motor) = FiveDigits(value);
  };
  put(f.Fs_plus, c.Fs_plus_N, c.Fs_plus_Nm);
  put(f.Fs_minus, c.Fs_minus_N, c.Fs_minus_Nm);
  put(f.Fc_plus, c.Fc_plus_N, c.Fc_plus_Nm);
  put(f.Fc_minus, c.Fc_minus_N, c.Fc_minus_Nm);
  put(at_table ? 1e3 * f.vs : f.vs, c.vs_mm_s, c.vs_rad_s);
  put(f.s0, c.sigma0_N_m, c.sigma0_Nm_rad);
  put(f.s1, c.sigma1_Ns_m, c.sigma1_Nms_rad);
  put(f.s2, c.sigma2_Ns_m, c.sigma2_Nms_rad);
  Uncertainty to(axis, config.uncertainty);
  to.Put("inertia", {"motor_inertia_kgm2"});
  to.Put("load_inertia", {"table_mass_kg"});
  to.Put("stiffness", {"screw_stiffness_N_um"});
  to.Put("damping", {"screw_damping_Ns_m"});
  to.PutFriction(at_table);
}

void IntoConfig(const StatedAxis& axis, LooseAxisFile& file) {
  LooseModelConfig& m = file.model;
  const double r = axis.table_per_q;
  Uncertainty to(axis, m.uncertainty);
  if (axis.linear) {
    m.mass_kg = FiveDigits(axis.motor_inertia);
    if (axis.two_inertia) {
      m.load_mass_kg = FiveDigits(axis.load_inertia);
      m.screw_stiffness_N_um = FiveDigits(1e-6 * axis.stiffness);
      m.screw_damping_Ns_m = FiveDigits(axis.damping);
    }
    to.Put("inertia", {"mass_kg"});
    to.Put("load_inertia", {"load_mass_kg"});
  } else {
    const bool in_kg = !m.load_inertia_kgm2 && m.table_mass_kg > 0.0;
    const double load = m.load_inertia_kgm2.value_or(r * r * m.table_mass_kg);
    const Shares shares = axis.two_inertia ? Shares{1.0, 0.0, 1.0} : SharesOf(*m.motor_inertia_kgm2, load);
    const double load_now = axis.two_inertia ? axis.load_inertia : shares.load * axis.motor_inertia;
    m.motor_inertia_kgm2 = FiveDigits(shares.motor * axis.motor_inertia);
    if (in_kg)
      m.table_mass_kg = FiveDigits(load_now / (r * r));
    else if (load_now > 0.0)
      m.load_inertia_kgm2 = FiveDigits(load_now);
    if (m.stiffness_Nm_rad) m.stiffness_Nm_rad = FiveDigits(axis.stiffness);
    if (m.screw_stiffness_N_um) m.screw_stiffness_N_um = FiveDigits(1e-6 * axis.stiffness / (r * r));
    if (m.damping_Nms_rad > 0.0 || m.stiffness_Nm_rad) {
      m.damping_Nms_rad = FiveDigits(axis.damping);
      m.screw_damping_Ns_m = 0.0;
    } else if (axis.two_inertia) {
      m.screw_damping_Ns_m = FiveDigits(axis.damping / (r * r));
    }
    if (m.load_inertia_kgm2) file.model.table_mass_kg = 0.0;
    const char* load_key = in_kg ? "table_mass_kg" : "load_inertia_kgm2";
    to.Put("inertia", {"motor_inertia_kgm2"}, shares.widen);
    if (!axis.two_inertia && load > 0.0) to.Put("inertia", {load_key}, shares.widen);
    to.Put("load_inertia", {load_key});
  }
  to.Put("stiffness", {m.stiffness_Nm_rad ? "stiffness_Nm_rad" : "screw_stiffness_N_um"});
  to.Put("damping", {m.damping_Nms_rad > 0.0 ? "damping_Nms_rad" : "screw_damping_Ns_m"});
  if (!axis.linear && !m.lead_mm) m.friction.acts_on = FrictionSide::kMotor;
  IntoFriction(axis, r, m.friction);
  to.PutFriction(axis.linear || m.friction.acts_on == FrictionSide::kTable);
  (axis.linear ? m.constant_force_N : m.constant_torque_Nm) = FiveDigits(axis.offset);
  to.Put("offset", {axis.linear ? "constant_force_N" : "constant_torque_Nm"});
  to.Put("delay", {"delay_ms"});
  to.Put("lag", {"lag_ms"});
  (axis.linear ? file.drive.force_constant_N_A : file.drive.torque_constant_Nm_A) =
      FiveDigits(axis.torque_constant);
  if (axis.endless || axis.to_and_fro) file.drive.endless = axis.endless;
}

std::string TextOf(const LooseAxisFile& file, ExtensionUnits units) {
  std::istringstream all(RenamedToFile(units, WriteYaml(file)));
  std::string out;
  for (std::string line; std::getline(all, line);)
    if (!StatesNothing(line)) out += line + "\n";
  return out;
}

}  // namespace contour::diagnosis
