#include "analysis/identification/result_files.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/text/format_text.h"
#include "config/whole_file.h"
#include "config/yaml_writer.h"

namespace contour::identify {
namespace {

using nlohmann::json;

/// The table's key of a friction value, and the motor's.
struct KeyPair {
  const char* table;
  const char* motor;
};
constexpr KeyPair kFrictionKeys[] = {
    {"Fs_plus_N", "Fs_plus_Nm"},       {"Fs_minus_N", "Fs_minus_Nm"},
    {"Fc_plus_N", "Fc_plus_Nm"},       {"Fc_minus_N", "Fc_minus_Nm"},
    {"vs_mm_s", "vs_rad_s"},           {"sigma0_N_m", "sigma0_Nm_rad"},
    {"sigma1_Ns_m", "sigma1_Nms_rad"}, {"sigma1_decay_mm_s", "sigma1_decay_rad_s"},
    {"sigma2_Ns_m", "sigma2_Nms_rad"},
};

std::string ModelKey(const std::string& key, FrictionSide side) {
  for (const KeyPair& k : kFrictionKeys)
    if (key == k.table) return side == FrictionSide::kTable ? k.table : k.motor;
  return key;
}

bool IsModelKey(const std::string& key) {
  if (key == "motor_inertia_kgm2" || key == "table_mass_kg" || key == "screw_stiffness_N_um" ||
      key == "screw_damping_Ns_m")
    return true;
  return std::any_of(std::begin(kFrictionKeys), std::end(kFrictionKeys),
                     [&](const KeyPair& k) { return key == k.table; });
}

/// Four digits and a bit: more than that nobody knows.
double Rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, 4 - std::floor(std::log10(std::fabs(value))));
  return std::round(value * scale) / scale;
}

void RoundAll(ModelConfig& m) {
  MechanicsConfig& c = m.mechanics;
  for (double* v : {&c.motor_inertia_kgm2, &c.table_mass_kg, &c.screw_stiffness_N_um, &c.screw_damping_Ns_m})
    *v = Rounded(*v);
  FrictionConfig& f = m.friction;
  for (double* v :
       {&f.Fs_plus_N, &f.Fs_minus_N, &f.Fc_plus_N, &f.Fc_minus_N, &f.vs_mm_s, &f.sigma0_N_m, &f.sigma1_Ns_m,
        &f.sigma1_decay_mm_s, &f.sigma2_Ns_m, &f.Fs_plus_Nm, &f.Fs_minus_Nm, &f.Fc_plus_Nm, &f.Fc_minus_Nm,
        &f.vs_rad_s, &f.sigma0_Nm_rad, &f.sigma1_Nms_rad, &f.sigma1_decay_rad_s, &f.sigma2_Nms_rad})
    *v = Rounded(*v);
}

const FittedParameter* Find(const Identification& id, const std::string& key) {
  for (const FittedParameter& p : id.fit.parameters)
    if (p.key == key) return &p;
  return nullptr;
}

json Points(const std::vector<LoopPoint>& points) {
  json t = json::array(), x = json::array(), f = json::array();
  for (const LoopPoint& p : points) {
    t.push_back(p.time_s);
    x.push_back(p.travel_m);
    f.push_back(p.friction_N);
  }
  return {{"time_s", t}, {"way_m", x}, {"friction_N", f}};
}

json Values(const TableAxis& a) {
  const diagnosis::StatedFriction& f = a.friction;
  return {{"motor_mass_kg", a.motor_inertia},
          {"table_mass_kg", a.load_inertia},
          {"mass_kg", a.mass_kg()},
          {"stiffness_N_m", a.stiffness},
          {"damping_Ns_m", a.damping},
          {"Fs_plus_N", f.Fs_plus},
          {"Fs_minus_N", f.Fs_minus},
          {"Fc_plus_N", f.Fc_plus},
          {"Fc_minus_N", f.Fc_minus},
          {"vs_m_s", f.vs},
          {"stribeck_exponent", f.exponent},
          {"sigma0_N_m", f.s0},
          {"sigma1_Ns_m", f.s1},
          {"sigma1_decay_m_s", f.vd},
          {"sigma2_Ns_m", f.s2},
          {"offset_N", a.offset},
          {"delay_s", a.delay_s},
          {"lag_s", a.lag_s}};
}

json Screw(const Identification& id) {
  json response = json::array();
  for (const ResponsePoint& p : id.shaken.response)
    response.push_back({{"frequency_Hz", p.frequency_Hz},
                        {"accelerance_1_kg", p.accelerance_1_kg},
                        {"coherence", p.coherence}});
  return {{"found", id.shaken.verdict == ShakenScrew::Verdict::kFound},
          {"antiresonance_Hz", id.shaken.antiresonance_Hz},
          {"resonance_Hz", id.shaken.resonance_Hz},
          {"period_s", id.period_s},
          {"wind_up_stiffness_N_m", id.wind_up.found ? json(id.wind_up.stiffness_N_m) : json(nullptr)},
          {"response", response}};
}

json Overlay(const Identification& id) {
  json time = json::array(), velocity = json::array(), measured = json::array(), simulated = json::array(),
       position = json::array();
  for (const OverlayPoint& p : id.overlay) {
    time.push_back(p.time_s);
    position.push_back(p.position_m);
    velocity.push_back(p.velocity_m_s);
    measured.push_back(p.friction_measured_N);
    simulated.push_back(p.friction_simulated_N);
  }
  return {{"time_s", time},
          {"position_m", position},
          {"velocity_m_s", velocity},
          {"measured_N", measured},
          {"simulated_N", simulated}};
}

}  // namespace

ModelConfig ToModel(const Identification& id, ModelConfig model) {
  IntoConfig(id.fit.axis, model);
  RoundAll(model);
  for (const FittedParameter& p : id.fit.parameters)
    if (p.relative && IsModelKey(p.key))
      model.uncertainty[ModelKey(p.key, model.friction.acts_on)] = std::min(10.0, Rounded(p.sigma));
  // A share has no relative deviation.
  if (const FittedParameter* share = Find(id, "motor_friction_share"))
    model.uncertainty["motor_share_rel"] = std::min(10.0, Rounded(share->sigma));
  if (const FittedParameter* side = Find(id, "side_frequency_Hz");
      side != nullptr && !model.side_modes.empty())
    model.side_modes.front().frequency_std_rel = std::min(0.5, Rounded(side->sigma));
  // The table goes with the motor when only the sum could be seen.
  if (Find(id, "table_mass_kg") == nullptr && id.fit.axis.two_inertia) {
    double& table = model.uncertainty["table_mass_kg"];
    table = std::max(table, model.uncertainty["motor_inertia_kgm2"]);
  }
  return model;
}

void WriteModelFile(const std::filesystem::path& file, const ModelConfig& model, const Identification& id,
                    const std::vector<std::string>& sources) {
  std::string text =
      "# Written by contour identify from " + FormatText("%.0f s of record", id.seconds) + ":\n";
  for (const std::string& s : sources) text += "#   " + s + "\n";
  const TableAxis& a = id.fit.axis;
  text += FormatText("# Friction levels are averages from %.1f to %.1f mm.\n", a.variation.low_m * 1e3,
                     a.variation.high_m * 1e3);
  if (const FittedParameter* lag = Find(id, "lag_s"))
    text += FormatText("# Torque path: delay %.3f ms, lag %.3f ms (+- %.3f); these are keys of drive:\n",
                       a.delay_s * 1e3, a.lag_s * 1e3, lag->sigma * 1e3);
  if (const FittedParameter* offset = Find(id, "offset_N"))
    text += FormatText("# Constant torque: %.5f +- %.5f Nm, no key of the model.\n",
                       a.offset * a.radius_m_rad, offset->sigma * a.radius_m_rad);
  if (const FittedParameter* share = Find(id, "motor_friction_share"))
    text += FormatText("# Share of the friction that acts on the motor: %.2f +- %.2f.\n",
                       a.motor_friction_share, share->sigma);
  if (a.side.share > 0.0)
    text += FormatText("# %.0f %% of the table's mass swings at %.0f Hz.\n", 100.0 * a.side.share,
                       a.side.frequency_Hz);
  text += FormatText("# Encoder: one step is %.4g um of travel, noise of a reading %.4g um.\n",
                     id.encoder.step_m * 1e6, id.encoder.noise_m * 1e6);
  for (const std::string& n : id.notes) text += "# Note: " + n + "\n";
  text +=
      "# uncertainty: relative, one standard deviation, from the scatter of the fit over blocks of time.\n";
  WriteWholeFile(file, text + WriteYaml(model));
}

void WriteIdentificationJson(const std::filesystem::path& file, const Identification& id,
                             const std::vector<std::string>& sources) {
  json parameters = json::object();
  for (const FittedParameter& p : id.fit.parameters)
    parameters[p.key] = {{"value", p.value}, {"sigma", p.sigma}, {"relative", p.relative}};
  json points = json::array();
  for (const StribeckPoint& p : id.stribeck)
    points.push_back({{"velocity_m_s", p.velocity_m_s},
                      {"friction_N", p.friction_N},
                      {"spread_N", p.spread_N},
                      {"way_m", p.travel_m}});
  json break_aways = json::array();
  for (const BreakAway& b : id.break_aways)
    break_aways.push_back({{"force_N", b.force_N}, {"velocity_m_s", b.velocity_m_s}});
  const json all = {
      {"sources", sources},
      {"seconds", id.seconds},
      {"notes", id.notes},
      {"stretch_m", {id.fit.axis.variation.low_m, id.fit.axis.variation.high_m}},
      {"stated", Values(id.stated)},
      {"stepwise", Values(id.stepwise)},
      {"identified", Values(id.fit.axis)},
      {"parameters", parameters},
      {"prediction_error_rms_m", {{"before", id.fit.error_rms_before_m}, {"after", id.fit.error_rms_m}}},
      {"stribeck_points", points},
      {"break_aways", break_aways},
      {"presliding",
       {{"reversals", id.presliding.reversals},
        {"sigma0_N_m", id.presliding.sigma0_N_m},
        {"spread_N_m", id.presliding.spread_N_m},
        {"measured", Points(id.loops)},
        {"simulated", Points(id.loops_simulated)}}},
      {"screw", Screw(id)},
      {"encoder", {{"step_m", id.encoder.step_m}, {"noise_m", id.encoder.noise_m}}},
      {"overlay", Overlay(id)},
  };
  WriteWholeFile(file, all.dump() + "\n");
}

std::string ResultTable(const Identification& id, const ModelConfig& before, const ModelConfig& after) {
  struct Row {
    const char* key;
    double before, after;
  };
  const MechanicsConfig& b = before.mechanics;
  const MechanicsConfig& a = after.mechanics;
  const double r = id.fit.axis.radius_m_rad;
  const Friction fb = ToSi(before.friction, r);
  const Friction fa = ToSi(after.friction, r);
  const Row rows[] = {
      {"motor_inertia_kgm2", b.motor_inertia_kgm2, a.motor_inertia_kgm2},
      {"table_mass_kg", b.table_mass_kg, a.table_mass_kg},
      {"screw_stiffness_N_um", b.screw_stiffness_N_um, a.screw_stiffness_N_um},
      {"screw_damping_Ns_m", b.screw_damping_Ns_m, a.screw_damping_Ns_m},
      {"Fs_plus_N", fb.Fs_plus_N, fa.Fs_plus_N},
      {"Fs_minus_N", fb.Fs_minus_N, fa.Fs_minus_N},
      {"Fc_plus_N", fb.Fc_plus_N, fa.Fc_plus_N},
      {"Fc_minus_N", fb.Fc_minus_N, fa.Fc_minus_N},
      {"vs_mm_s", fb.vs_m_s * 1e3, fa.vs_m_s * 1e3},
      {"sigma0_N_m", fb.sigma0_N_m, fa.sigma0_N_m},
      {"sigma1_Ns_m", fb.sigma1_Ns_m, fa.sigma1_Ns_m},
      {"sigma1_decay_mm_s", fb.sigma1_decay_m_s * 1e3, fa.sigma1_decay_m_s * 1e3},
      {"sigma2_Ns_m", fb.sigma2_Ns_m, fa.sigma2_Ns_m},
  };
  std::string text = FormatText("%-22s %12s %12s   95 %% interval\n", "", "stated", "identified");
  for (const Row& row : rows) {
    text += FormatText("%-22s %12.5g %12.5g", row.key, row.before, row.after);
    if (const FittedParameter* p = Find(id, row.key)) {
      // The model may leave open what the fit holds for known: how the mass is split.
      const auto left_open = after.uncertainty.find(row.key);
      const double sigma =
          left_open == after.uncertainty.end() ? p->sigma : std::max(p->sigma, left_open->second);
      text += FormatText("   %.5g to %.5g", row.after * std::exp(-1.96 * sigma),
                         row.after * std::exp(1.96 * sigma));
    } else {
      text += row.before == row.after ? "   not identified, as stated"
                                      : "   with the motor's, in the stated ratio";
    }
    text += "\n";
  }
  for (const std::string& n : id.notes) text += "note: " + n + "\n";
  return text;
}

}  // namespace contour::identify
