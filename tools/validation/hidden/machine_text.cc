#include "tools/validation/hidden/machine_text.h"

#include "analysis/text/format_text.h"

namespace contour::hidden {
namespace {

constexpr double kBreakAwaySpread = 6.0;

void AddAxis(std::string& text, const char* name, int node, const Setting& s) {
  const TrueAxis& m = s.stated;
  text +=
      FormatText("  %s:\n    drive: {bus: %s, node_id: %d, rated_torque_Nm: %.9g, peak_torque_Nm: 1.911, ",
                 name, node == 1 ? "main" : "other", node, m.rated_torque_Nm);
  text += FormatText(
      "absolute_encoder: true, encoder_counts_per_rev: %.9g, lag_ms: %.9g, quick_stop_deceleration_rad_s2: "
      "6000",
      m.encoder_counts_per_rev, m.lag_ms);
  if (m.scale_counts_per_mm > 0.0)
    text += FormatText(", linear_scale: {counts_per_mm: %.9g}", m.scale_counts_per_mm);
  text +=
      FormatText("}\n    limits: {position_mm: [%.9g, %.9g], velocity_mm_s: %.9g, acceleration_mm_s2: 3000, ",
                 -m.half_stroke_mm - 10.0, m.half_stroke_mm + 10.0, kSpeedLimit_mm_s);
  text += "jerk_mm_s3: 500000, torque_Nm: 1.5, following_error_mm: 2, safe_travel_mm: 30}\n";
  text += FormatText(
      "    model:\n      lead_mm: %.9g\n      motor_inertia_kgm2: %.9g\n      table_mass_kg: %.9g\n",
      m.lead_mm, m.motor_inertia_kgm2, m.table_mass_kg);
  text += FormatText("      screw_stiffness_N_um: %.9g\n      screw_damping_Ns_m: %.9g\n", m.stiffness_N_um,
                     m.damping_Ns_m);
  text += FormatText(
      "      friction: {acts_on: table, stribeck_exponent: %d, Fs_plus_N: %.9g, Fs_minus_N: %.9g, ",
      m.stribeck_exponent, m.Fs_N, m.Fs_N);
  text +=
      FormatText("Fc_plus_N: %.9g, Fc_minus_N: %.9g, vs_mm_s: %.9g, sigma0_N_m: %.9g, sigma1_Ns_m: %.9g, ",
                 m.Fc_N, m.Fc_N, m.vs_mm_s, m.sigma0_N_m, m.sigma1_Ns_m);
  text += FormatText("sigma1_decay_mm_s: %.9g, sigma2_Ns_m: %.9g}\n", m.sigma1_decay_mm_s, m.sigma2_Ns_m);
}

void AddEmulated(std::string& text, const char* name, const Setting& s) {
  const TrueAxis& t = s.truth;
  text += FormatText("    %s:\n      motor_inertia_kgm2: %.9g\n      table_mass_kg: %.9g\n", name,
                     t.motor_inertia_kgm2, t.table_mass_kg);
  text += FormatText("      screw_stiffness_N_um: %.9g\n      screw_damping_Ns_m: %.9g\n", t.stiffness_N_um,
                     t.damping_Ns_m);
  text += FormatText("      lag_ms: %.9g\n      torque_noise_Nm: %.9g\n      stroke_mm: %.9g\n", t.lag_ms,
                     t.torque_noise_Nm, EmulatedStroke_mm(t));
  text += "      start_variation_mm: 0\n";
  if (s.temperature)
    text +=
        "      temperature: {start_degC: 20, ambient_degC: 20, reference_degC: 20, rise_K_W: 3, "
        "time_constant_s: 12}\n";
  text += FormatText("      friction: {law: %s, stribeck_exponent: %d, Fs_plus_N: %.9g, Fs_minus_N: %.9g, ",
                     s.misfit == Misfit::kMaxwellSlip ? "maxwell_slip" : "lugre", t.stribeck_exponent, t.Fs_N,
                     t.Fs_N);
  text +=
      FormatText("Fc_plus_N: %.9g, Fc_minus_N: %.9g, vs_mm_s: %.9g, sigma0_N_m: %.9g, sigma1_Ns_m: %.9g, ",
                 t.Fc_N, t.Fc_N, t.vs_mm_s, t.sigma0_N_m, t.sigma1_Ns_m);
  text += FormatText("sigma1_decay_mm_s: %.9g, sigma2_Ns_m: %.9g, position_amplitude_rel: 0, ",
                     t.sigma1_decay_mm_s, t.sigma2_Ns_m);
  text += "ripple_amplitude_rel: 0";
  if (s.misfit == Misfit::kMaxwellSlip) {
    // Elements that break away over a range with the axis's own presliding distance in its middle.
    const double presliding_um = 1e6 * t.Fs_N / t.sigma0_N_m;
    text += FormatText(", breakaway_min_um: %.9g, breakaway_max_um: %.9g", presliding_um / kBreakAwaySpread,
                       presliding_um * kBreakAwaySpread);
  }
  text += "}\n";
}

}  // namespace

std::string MachineText(const Setting& s) {
  std::string text =
      "machine: {name: hidden, cycle_us: 1000, controller: pid}\n"
      "buses:\n  main: {interface: loopback, bitrate_bit_s: 1000000}\n";
  if (s.second_axis) text += "  other: {interface: loopback, bitrate_bit_s: 1000000}\n";
  text += "axes:\n";
  AddAxis(text, "x", 1, s);
  if (s.second_axis) AddAxis(text, "y", 2, s);
  text += FormatText("emulator:\n  seed: %llu\n  parameter_variation_rel: 0\n  axes:\n",
                     static_cast<unsigned long long>(s.seed % 1000000007ULL));
  AddEmulated(text, "x", s);
  if (s.second_axis) AddEmulated(text, "y", s);
  return text;
}

std::string ModelText(const Setting& s) {
  const TrueAxis& m = s.stated;
  const double lever = m.radius_m_rad();
  std::string text;
  text += FormatText("model:\n  lead_mm: %.9g\n", m.lead_mm);
  if (s.rigid) {
    // Everything that turns, seen at the motor; friction there as well.
    text +=
        FormatText("  motor_inertia_kgm2: %.9g\n", m.motor_inertia_kgm2 + lever * lever * m.table_mass_kg);
    text += FormatText(
        "  friction: {acts_on: motor, stribeck_exponent: %d, Fc_plus_Nm: %.9g, Fc_minus_Nm: %.9g, ",
        m.stribeck_exponent, m.Fc_N * lever, m.Fc_N * lever);
    text += FormatText("Fs_plus_Nm: %.9g, Fs_minus_Nm: %.9g, vs_rad_s: %.9g, ", m.Fs_N * lever,
                       m.Fs_N * lever, m.vs_rad_s());
    text += FormatText("sigma0_Nm_rad: %.9g, sigma1_Nms_rad: %.9g, ", m.sigma0_N_m * lever * lever,
                       m.sigma1_Ns_m * lever * lever);
    text += FormatText("sigma1_decay_rad_s: %.9g, sigma2_Nms_rad: %.9g}\n",
                       m.sigma1_decay_mm_s * 1e-3 / lever, m.sigma2_Ns_m * lever * lever);
  } else {
    text += FormatText("  motor_inertia_kgm2: %.9g\n  table_mass_kg: %.9g\n", m.motor_inertia_kgm2,
                       m.table_mass_kg);
    text += FormatText("  screw_stiffness_N_um: %.9g\n  screw_damping_Ns_m: %.9g\n", m.stiffness_N_um,
                       m.damping_Ns_m);
    text +=
        FormatText("  friction: {acts_on: table, stribeck_exponent: %d, Fc_plus_N: %.9g, Fc_minus_N: %.9g, ",
                   m.stribeck_exponent, m.Fc_N, m.Fc_N);
    text += FormatText("Fs_plus_N: %.9g, Fs_minus_N: %.9g, vs_mm_s: %.9g, ", m.Fs_N, m.Fs_N, m.vs_mm_s);
    text += FormatText("sigma0_N_m: %.9g, sigma1_Ns_m: %.9g, ", m.sigma0_N_m, m.sigma1_Ns_m);
    text += FormatText("sigma1_decay_mm_s: %.9g, sigma2_Ns_m: %.9g}\n", m.sigma1_decay_mm_s, m.sigma2_Ns_m);
  }
  const char* side = s.rigid ? "Nm" : "N";
  text += FormatText("  uncertainty: {motor_inertia_kgm2: 0.05, %s", s.rigid ? "" : "table_mass_kg: 0.05, ");
  if (!s.rigid) text += "screw_stiffness_N_um: 0.1, screw_damping_Ns_m: 0.3, ";
  text += FormatText("Fc_plus_%s: 0.1, Fc_minus_%s: 0.1, Fs_plus_%s: 0.1, Fs_minus_%s: 0.1, ", side, side,
                     side, side);
  text += s.rigid ? "vs_rad_s: 0.2, sigma0_Nm_rad: 0.2, sigma1_Nms_rad: 0.3, sigma2_Nms_rad: 0.15, "
                  : "vs_mm_s: 0.2, sigma0_N_m: 0.2, sigma1_Ns_m: 0.3, sigma2_Ns_m: 0.15, ";
  text += "delay_ms: 0.005, lag_ms: 0.1}\n";
  text +=
      FormatText("drive: {delay_ms: 1, lag_ms: %.9g, encoder_counts_per_rev: %.9g, torque_step_Nm: %.9g, ",
                 m.lag_ms, m.encoder_counts_per_rev, m.rated_torque_Nm * 1e-3);
  text += FormatText("rated_torque_Nm: %.9g, stroke_mm: [%.9g, %.9g]}\n", m.rated_torque_Nm,
                     -m.half_stroke_mm - 10.0, m.half_stroke_mm + 10.0);
  return text;
}

}  // namespace contour::hidden
