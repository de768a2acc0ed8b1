#include "analysis/axis_model/loose_axis.h"

#include <numbers>

#include "analysis/axis_model/apply_extensions.h"
#include "analysis/axis_model/stated_parameters.h"
#include "config/yaml_writer.h"

namespace contour::diagnosis {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
/// Where nobody stated a bristle stiffness, friction comes to its level within a few micrometres of travel;
/// where nobody stated a Stribeck velocity, it falls within a few millimetres per second. Docs say so.
constexpr double kAssumedPresliding_m = 2e-6;
constexpr double kAssumedStribeck_m_s = 2e-3;
/// Travel per radian of an axis whose lead is not known: as a screw of 5 mm.
constexpr double kAssumedRadius_m_rad = 5e-3 / kTwoPi;

class Converter {
 public:
  Converter(const LooseAxisFile& file, const YamlValue& tree, std::string model_key,
            std::vector<std::string>& errors)
      : model_(file.model),
        drive_(file.drive),
        tree_(tree),
        model_key_(std::move(model_key)),
        errors_(errors) {}

  StatedAxis Convert() {
    axis_.linear = model_.mass_kg.has_value();
    if (axis_.linear)
      Linear();
    else
      Rotary();
    axis_.delay_s = drive_.delay_ms * 1e-3;
    axis_.lag_s = drive_.lag_ms * 1e-3;
    if (!axis_.linear) {
      ApplyNumbers(model_.extensions, axis_);
      ApplyExtras(model_.extensions, axis_);
    }
    if (drive_.stroke_mm) {
      axis_.stroke_min_m = (*drive_.stroke_mm)[0] * 1e-3;
      axis_.stroke_max_m = (*drive_.stroke_mm)[1] * 1e-3;
      Demand(axis_.stroke_min_m < axis_.stroke_max_m, "drive.stroke_mm", "expected the lower end first");
    }
    for (const auto& [key, value] : model_.uncertainty)
      Demand(IsUncertaintyKey(key), Model("uncertainty." + key),
             "found a key that is no parameter of a model");
    return axis_;
  }

 private:
  void Demand(bool ok, const std::string& key, const std::string& text) {
    if (!ok) errors_.push_back(WhereIs(tree_, key) + ": " + key + ": " + text);
  }
  void Only(const char* kind, bool given, const std::string& key) {
    Demand(!given, key,
           std::string("found on a ") + (axis_.linear ? "linear" : "rotary") + " axis, expected on a " +
               kind + " one only");
  }
  std::string Model(const std::string& key) const {
    return model_key_.empty() ? key : model_key_ + "." + key;
  }

  void Linear() {
    Only("rotary", model_.motor_inertia_kgm2.has_value(), Model("motor_inertia_kgm2"));
    Only("rotary", model_.load_inertia_kgm2.has_value(), Model("load_inertia_kgm2"));
    Only("rotary", model_.table_mass_kg != 0.0, Model("table_mass_kg"));
    Only("rotary", model_.stiffness_Nm_rad.has_value(), Model("stiffness_Nm_rad"));
    Only("rotary", model_.damping_Nms_rad != 0.0, Model("damping_Nms_rad"));
    Only("rotary", model_.constant_torque_Nm != 0.0, Model("constant_torque_Nm"));
    // Extensions are stated at a motor; no controller here has a linear one.
    Only("rotary", !WriteYaml(model_.extensions).empty(), Model("extensions"));
    Only("rotary", drive_.encoder_counts_per_rev != 0.0, "drive.encoder_counts_per_rev");
    Only("rotary", drive_.rated_torque_Nm != 0.0, "drive.rated_torque_Nm");
    Only("rotary", drive_.torque_step_Nm != 0.0, "drive.torque_step_Nm");
    axis_.table_per_q = 1.0;
    axis_.lead_m = model_.lead_mm.value_or(0.0) * 1e-3;
    axis_.two_inertia = model_.load_mass_kg.has_value();
    Demand(axis_.two_inertia == model_.screw_stiffness_N_um.has_value(), Model("mass_kg"),
           "a second mass takes load_mass_kg and screw_stiffness_N_um, both");
    axis_.motor_inertia = *model_.mass_kg;
    axis_.load_inertia = model_.load_mass_kg.value_or(0.0);
    axis_.stiffness = model_.screw_stiffness_N_um.value_or(0.0) * 1e6;
    axis_.damping = model_.screw_damping_Ns_m;
    axis_.offset = model_.constant_force_N;
    axis_.position_step = drive_.position_step_um * 1e-6;
    axis_.command_step = drive_.force_step_N;
    axis_.rated = drive_.rated_force_N;
    Demand(model_.friction.acts_on == FrictionSide::kTable, Model("friction.acts_on"),
           "found motor on a linear axis, expected table: values in N");
    axis_.friction_on_load = axis_.two_inertia;
    axis_.friction = Friction(1.0);
    axis_.sigma = EngineSigmas(model_.uncertainty);
    SetInertiaSigma(axis_, Find(model_.uncertainty, "mass_kg"), Find(model_.uncertainty, "load_mass_kg"),
                    axis_.motor_inertia, axis_.load_inertia);
  }

  void Rotary() {
    const bool at_table = model_.friction.acts_on == FrictionSide::kTable;
    Demand(model_.motor_inertia_kgm2.has_value(), Model("motor_inertia_kgm2"),
           "missing, expected a number above 0 for a rotary axis, or mass_kg for a linear one");
    Demand(model_.lead_mm || (!at_table && model_.table_mass_kg == 0.0 && !model_.screw_stiffness_N_um &&
                              model_.screw_damping_Ns_m == 0.0),
           Model("lead_mm"),
           "missing, expected a number where anything is stated at the table, as friction is unless acts_on: "
           "motor");
    Only("linear", model_.load_mass_kg.has_value(), Model("load_mass_kg"));
    Only("linear", model_.constant_force_N != 0.0, Model("constant_force_N"));
    Only("linear", drive_.position_step_um != 0.0, "drive.position_step_um");
    Only("linear", drive_.force_step_N != 0.0, "drive.force_step_N");
    Only("linear", drive_.rated_force_N != 0.0, "drive.rated_force_N");
    Demand(!model_.load_inertia_kgm2 || model_.table_mass_kg == 0.0, Model("load_inertia_kgm2"),
           "found together with table_mass_kg, expected one of the two");
    Demand(!model_.stiffness_Nm_rad || !model_.screw_stiffness_N_um, Model("stiffness_Nm_rad"),
           "found together with screw_stiffness_N_um, expected one of the two");
    if (!errors_.empty()) return;

    axis_.lead_m = model_.lead_mm.value_or(0.0) * 1e-3;
    const double radius = model_.lead_mm ? axis_.lead_m / kTwoPi : kAssumedRadius_m_rad;
    axis_.table_per_q = radius;
    const double load = model_.load_inertia_kgm2.value_or(radius * radius * model_.table_mass_kg);
    axis_.two_inertia = model_.stiffness_Nm_rad || model_.screw_stiffness_N_um;
    Demand(!axis_.two_inertia || load > 0.0, Model("table_mass_kg"),
           "missing, expected a load behind the stiffness: table_mass_kg or load_inertia_kgm2");
    axis_.motor_inertia = *model_.motor_inertia_kgm2 + (axis_.two_inertia ? 0.0 : load);
    axis_.load_inertia = axis_.two_inertia ? load : 0.0;
    axis_.stiffness =
        model_.stiffness_Nm_rad.value_or(model_.screw_stiffness_N_um.value_or(0.0) * 1e6 * radius * radius);
    axis_.damping = model_.damping_Nms_rad + model_.screw_damping_Ns_m * radius * radius;
    axis_.offset = model_.constant_torque_Nm;
    axis_.position_step = drive_.encoder_counts_per_rev > 0.0 ? kTwoPi / drive_.encoder_counts_per_rev : 0.0;
    axis_.command_step = drive_.torque_step_Nm;
    axis_.rated = drive_.rated_torque_Nm;
    axis_.friction_on_load = axis_.two_inertia && at_table;
    axis_.friction = Friction(radius);
    axis_.sigma = EngineSigmas(model_.uncertainty);
    const char* load_key = model_.load_inertia_kgm2 ? "load_inertia_kgm2" : "table_mass_kg";
    SetInertiaSigma(axis_, Find(model_.uncertainty, "motor_inertia_kgm2"), Find(model_.uncertainty, load_key),
                    *model_.motor_inertia_kgm2, load);
  }

  /// At q; `radius` is the table's travel per unit of q.
  StatedFriction Friction(double radius) const {
    const LooseFrictionConfig& c = model_.friction;
    const bool at_table = axis_.linear || c.acts_on == FrictionSide::kTable;
    const double metres = at_table ? 1.0 : radius;    // per unit of the coordinate that friction is stated in
    const double speed_unit = at_table ? 1e-3 : 1.0;  // mm/s or rad/s
    StatedFriction f;
    f.Fc_plus = c.Fc_plus;
    f.Fc_minus = c.Fc_minus;
    f.Fs_plus = c.Fs_plus.value_or(c.Fc_plus);
    f.Fs_minus = c.Fs_minus.value_or(c.Fc_minus);
    f.exponent = c.stribeck_exponent;
    f.vs = c.vs ? *c.vs * speed_unit : kAssumedStribeck_m_s / metres;
    f.s0 = c.sigma0.value_or(0.5 * (c.Fc_plus + c.Fc_minus) * metres / kAssumedPresliding_m);
    f.s1 = c.sigma1.value_or(0.0);
    f.vd = c.sigma1_decay.value_or(0.0) * speed_unit;
    f.s2 = c.sigma2;
    return at_table && !axis_.linear ? SeenAtQ(f, radius) : f;
  }

  const LooseModelConfig& model_;
  const LooseDriveConfig& drive_;
  const YamlValue& tree_;
  std::string model_key_;
  std::vector<std::string>& errors_;
  StatedAxis axis_;
};

}  // namespace

StatedAxis ToStatedAxis(const LooseAxisFile& file, const YamlValue& tree, const std::string& model_key,
                        std::vector<std::string>& errors) {
  return Converter(file, tree, model_key, errors).Convert();
}

}  // namespace contour::diagnosis
