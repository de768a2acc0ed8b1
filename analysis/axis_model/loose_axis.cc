#include "analysis/axis_model/loose_axis.h"

#include <numbers>

#include "analysis/axis_model/apply_extensions.h"
#include "analysis/axis_model/stated_parameters.h"

namespace contour::diagnosis {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
/// Where nobody stated a bristle stiffness, friction comes to its level within a few micrometres of travel;
/// where nobody stated a Stribeck velocity, it falls within a few millimetres per second. Docs say so.
constexpr double kAssumedPresliding_m = 2e-6;
constexpr double kAssumedStribeck_m_s = 2e-3;
/// The same where there is no lead: as behind a screw of 5 mm. A log says more (CompleteFromLog).
constexpr double kAssumedPresliding_rad = 2.5e-3;
constexpr double kAssumedStribeck_rad_s = 2.5;

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
    ApplyNumbers(model_.extensions, axis_);
    ApplyExtras(model_.extensions, axis_);
    axis_.motor_share = axis_.friction_on_load ? model_.friction.motor_share_rel : 0.0;
    Demand(!(drive_.endless.value_or(false) && drive_.stroke_mm), "drive.stroke_mm",
           "found on an endless axis, expected none");
    if (!drive_.stroke_mm) axis_.open.insert("stroke");
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
    Only("rotary", model_.gear_ratio != 1.0, Model("gear_ratio"));
    Only("rotary", drive_.endless.has_value(), "drive.endless");
    Only("rotary", drive_.torque_constant_Nm_A != 0.0, "drive.torque_constant_Nm_A");
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
    axis_.torque_constant = drive_.force_constant_N_A;
    Demand(model_.friction.acts_on == FrictionSide::kTable, Model("friction.acts_on"),
           "found motor on a linear axis, expected table: values in N");
    axis_.friction_on_load = axis_.two_inertia;
    axis_.friction = Friction(true, 1.0);
    axis_.sigma = EngineSigmas(model_.uncertainty);
    SetInertiaSigma(axis_, Find(model_.uncertainty, "mass_kg"), Find(model_.uncertainty, "load_mass_kg"),
                    axis_.motor_inertia, axis_.load_inertia);
  }

  void Rotary() {
    const YamlValue* tree = model_key_.empty() ? &tree_ : &tree_.Find(model_key_)->value;
    const bool at_table =
        model_.friction.acts_on == FrictionSide::kTable && tree->Find("friction") != nullptr;
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
    Only("linear", drive_.force_constant_N_A != 0.0, "drive.force_constant_N_A");
    Demand(!model_.load_inertia_kgm2 || model_.table_mass_kg == 0.0, Model("load_inertia_kgm2"),
           "found together with table_mass_kg, expected one of the two");
    Demand(!model_.stiffness_Nm_rad || !model_.screw_stiffness_N_um, Model("stiffness_Nm_rad"),
           "found together with screw_stiffness_N_um, expected one of the two");
    if (!errors_.empty()) return;

    axis_.lead_m = model_.lead_mm.value_or(0.0) * 1e-3;
    // Without a lead the axis itself is the table: places are in rad.
    const double radius = model_.lead_mm ? axis_.lead_m / kTwoPi : 1.0;
    Demand(
        !model_.lead_mm || model_.gear_ratio == 1.0, Model("gear_ratio"),
        "found together with lead_mm, expected one of the two: behind a screw the log has the motor's angle");
    axis_.gear_ratio = model_.gear_ratio;
    axis_.endless = drive_.endless.value_or(false);
    axis_.to_and_fro = drive_.endless == false;
    axis_.torque_constant = drive_.torque_constant_Nm_A;
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
    axis_.friction = Friction(at_table, radius);
    axis_.sigma = EngineSigmas(model_.uncertainty);
    const char* load_key = model_.load_inertia_kgm2 ? "load_inertia_kgm2" : "table_mass_kg";
    SetInertiaSigma(axis_, Find(model_.uncertainty, "motor_inertia_kgm2"), Find(model_.uncertainty, load_key),
                    *model_.motor_inertia_kgm2, load);
  }

  /// At q; `radius` is the table's travel per unit of q. What is left out gets a placeholder and is open.
  StatedFriction Friction(bool at_table, double radius) {
    const LooseFrictionConfig& c = model_.friction;
    const double metres = at_table ? 1.0 : radius;    // per unit of the coordinate that friction is stated in
    const double speed_unit = at_table ? 1e-3 : 1.0;  // mm/s or rad/s
    const bool no_lead = !axis_.linear && axis_.lead_m == 0.0;
    const double presliding = no_lead ? kAssumedPresliding_rad : kAssumedPresliding_m / metres;
    const auto leave_open = [&](const char* name, bool stated) {
      if (!stated) axis_.open.insert(name);
    };
    leave_open("Fc", c.Fc_plus || c.Fc_minus);
    leave_open("vs", c.vs.has_value());
    leave_open("s0", c.sigma0.has_value());
    leave_open("s2", c.sigma2.has_value());
    leave_open("exponent", c.stribeck_exponent.has_value() || c.vs.has_value());
    StatedFriction f;
    f.Fc_plus = c.Fc_plus.value_or(c.Fc_minus.value_or(1.0));
    f.Fc_minus = c.Fc_minus.value_or(f.Fc_plus);
    f.Fs_plus = c.Fs_plus.value_or(f.Fc_plus);
    f.Fs_minus = c.Fs_minus.value_or(f.Fc_minus);
    f.exponent = c.stribeck_exponent.value_or(1.0);
    f.vs = c.vs ? *c.vs * speed_unit : no_lead ? kAssumedStribeck_rad_s : kAssumedStribeck_m_s / metres;
    f.s0 = c.sigma0.value_or(0.5 * (f.Fc_plus + f.Fc_minus) / presliding);
    f.s1 = c.sigma1.value_or(0.0);
    f.vd = c.sigma1_decay.value_or(0.0) * speed_unit;
    f.s2 = c.sigma2.value_or(0.0);
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
