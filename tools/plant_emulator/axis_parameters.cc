#include "tools/plant_emulator/axis_parameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/plant_emulator/random.h"

namespace contour::plant {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kMostSwinging = 0.9;

[[noreturn]] void Refuse(const std::string& axis, const std::string& what) {
  throw std::invalid_argument("emulator.axes." + axis + ": " + what);
}

void Check(const EmulatedAxisConfig& c, const std::string& axis) {
  const EmulatedFrictionConfig& f = c.friction;
  if (f.Fs_plus_N < f.Fc_plus_N || f.Fs_minus_N < f.Fc_minus_N)
    Refuse(axis, "friction.Fs_N is below Fc_N in one direction; break-away cannot be easier than sliding");
  if (!(c.motor_inertia_kgm2 > 0.0) || !(c.table_mass_kg > 0.0) || !(c.screw_stiffness_N_um > 0.0))
    Refuse(axis, "inertia, mass and stiffness must be positive");
  if (f.stribeck_exponent != 1 && f.stribeck_exponent != 2)
    Refuse(axis, "friction.stribeck_exponent must be 1 or 2");
  if (f.position_amplitude_rel + f.ripple_amplitude_rel >= 1.0)
    Refuse(axis,
           "position and ripple variation together must stay below 1, or friction would drive the table");
  double swinging = 0.0;
  for (const EmulatedSideModeConfig& mode : c.side_modes) swinging += mode.mass_share_rel;
  if (swinging > kMostSwinging)
    Refuse(axis, "side_modes: their mass_share_rel together must stay below 0.9; the rest is the table");
  const auto check_table = [&](const std::string& name, const std::vector<double>& position_mm,
                               std::size_t values) {
    if (position_mm.empty() || position_mm.size() != values)
      Refuse(axis, name + ": as many positions as values are needed, and at least one");
    if (!std::is_sorted(position_mm.begin(), position_mm.end()))
      Refuse(axis, name + ".position_mm must ascend");
  };
  if (const auto& map = c.effects.friction_map)
    check_table("effects.friction_map", map->position_mm, map->friction_rel.size());
  if (const auto& map = c.effects.pitch_map)
    check_table("effects.pitch_map", map->position_mm, map->error_um.size());
}

void SetFriction(AxisParameters& p, const EmulatedFrictionConfig& f, Random& random, double variation) {
  const auto vary = [&](double value) { return value * (1.0 + random.Uniform(-variation, variation)); };
  FrictionParameters& base = p.friction.base;
  base.plus = {vary(f.Fs_plus_N), vary(f.Fc_plus_N)};
  base.minus = {vary(f.Fs_minus_N), vary(f.Fc_minus_N)};
  base.plus.Fs_N = std::max(base.plus.Fs_N, base.plus.Fc_N);
  base.minus.Fs_N = std::max(base.minus.Fs_N, base.minus.Fc_N);
  base.vs_m_s = vary(f.vs_mm_s) * 1e-3;
  base.stribeck_exponent = f.stribeck_exponent;
  base.sigma0_N_m = vary(f.sigma0_N_m);
  base.sigma1_Ns_m = vary(f.sigma1_Ns_m);
  base.sigma1_decay_m_s = f.sigma1_decay_mm_s * 1e-3;
  base.sigma2_Ns_m = vary(f.sigma2_Ns_m);
  p.law = f.law;
  p.friction.elements = static_cast<std::size_t>(f.elements);
  p.friction.breakaway_min_m = f.breakaway_min_um * 1e-6;
  p.friction.breakaway_max_m = f.breakaway_max_um * 1e-6;
  p.friction.attraction_N_s = f.attraction_N_s;
  p.friction_temperature_rate_1_K = f.temperature_rate_1_K;
  p.motor_friction_share = f.motor_share_rel;
}

SideMode MakeSideMode(const EmulatedSideModeConfig& c, double table_mass_kg, Random& random,
                      double variation) {
  const double omega = kTwoPi * c.frequency_Hz * (1.0 + random.Uniform(-variation, variation));
  const double mass_kg = c.mass_share_rel * table_mass_kg;
  return {mass_kg, mass_kg * omega * omega, 2.0 * c.damping_ratio * mass_kg * omega};
}

/// Effects that are other values of parameters the axis has anyway.
void ApplyToParameters(AxisParameters& p) {
  FrictionParameters& base = p.friction.base;
  if (const auto& e = p.effects.asymmetric_coulomb) {
    for (FrictionLevels* level : {&base.plus, &base.minus}) {
      const double factor = 1.0 + (level == &base.plus ? 0.5 : -0.5) * e->difference_rel;
      level->Fs_N *= factor;
      level->Fc_N *= factor;
    }
  }
  if (const auto& e = p.effects.stribeck) {
    base.plus.Fs_N = base.plus.Fc_N * e->Fs_over_Fc;
    base.minus.Fs_N = base.minus.Fc_N * e->Fs_over_Fc;
    base.vs_m_s = e->vs_rad_s * p.radius_m_rad;
  }
  if (const auto& e = p.effects.compliance) {
    const double omega = kTwoPi * e->antiresonance_Hz;
    p.stiffness_N_m = p.table_mass_kg * omega * omega;
    // Mode of the relative motion: 2 zeta omega_r = c (1/m_m + 1/Mt).
    const double inverse_mass =
        1.0 / p.table_mass_kg + p.radius_m_rad * p.radius_m_rad / p.motor_inertia_kgm2;
    p.damping_Ns_m = 2.0 * e->damping_ratio * std::sqrt(p.stiffness_N_m * inverse_mass) / inverse_mass;
  }
  if (const auto& e = p.effects.input_delay) p.delay_ns = std::llround(e->delay_us * 1e3);
  if (const auto& e = p.effects.current_lag) p.lag_s += e->time_constant_us * 1e-6;
}

}  // namespace

AxisParameters MakeAxisParameters(const EmulatedAxisConfig& config, const EmulatedAxisPlacement& placement,
                                  std::uint64_t seed, double variation_rel, std::uint64_t stream) {
  Check(config, placement.name);
  Random random(seed, stream);
  const auto vary = [&](double value) {
    return value * (1.0 + random.Uniform(-variation_rel, variation_rel));
  };
  AxisParameters p;
  p.radius_m_rad = config.lead_mm.value_or(placement.lead_mm) * 1e-3 / kTwoPi;
  p.motor_inertia_kgm2 = vary(config.motor_inertia_kgm2);
  p.table_mass_kg = vary(config.table_mass_kg);
  p.stiffness_N_m = vary(config.screw_stiffness_N_um * 1e6);
  p.damping_Ns_m = vary(config.screw_damping_Ns_m);
  p.half_stroke_m = 0.5e-3 * config.stroke_mm;
  p.start_position_m = 1e-3 * (config.start_position_mm +
                               random.Uniform(-config.start_variation_mm, config.start_variation_mm));
  SetFriction(p, config.friction, random, variation_rel);
  const FrictionParameters& base = p.friction.base;
  p.start_bristle_N = random.Uniform(-0.5, 0.5) * std::min(base.plus.Fc_N, base.minus.Fc_N);
  const double turn = config.friction.ripple_order_per_rev;
  p.stroke = {config.friction.position_amplitude_rel, kTwoPi / (2.0 * p.half_stroke_m),
              random.Uniform(0.0, kTwoPi)};
  p.ripple_plus = {config.friction.ripple_amplitude_rel, turn, random.Uniform(0.0, kTwoPi)};
  p.ripple_minus = {config.friction.ripple_amplitude_rel, turn, random.Uniform(0.0, kTwoPi)};
  // The drive knows its rated torque as whole mNm (0x6076), so that is what it has.
  p.rated_torque_Nm = 1e-3 * std::round(1e3 * config.rated_torque_Nm.value_or(placement.rated_torque_Nm));
  p.peak_torque_Nm = config.peak_torque_Nm.value_or(placement.peak_torque_Nm);
  if (!(p.rated_torque_Nm > 0.0)) Refuse(placement.name, "rated_torque_Nm must be at least 1 mNm");
  p.lag_s = config.lag_ms * 1e-3;
  p.delay_cycles = config.delay_cycles;
  p.answer_delay_ns = static_cast<std::int64_t>(config.answer_delay_us * 1e3);
  p.answer_delay_every = config.answer_delay_every;
  p.encoder_counts_per_rev = config.encoder_counts_per_rev.value_or(placement.encoder_counts_per_rev);
  p.scale_counts_per_m = 1e3 * config.scale_counts_per_mm.value_or(placement.scale_counts_per_mm);
  p.encoder_noise_lsb = config.encoder_noise_lsb;
  p.incremental_encoder = config.incremental_encoder;
  p.torque_mode = config.torque_mode;
  p.csp_mode = config.csp_mode;
  p.torque_noise_Nm = config.torque_noise_Nm;
  p.torque_noise_change = config.torque_noise_change;
  p.torque_noise_change_s = config.torque_noise_change_s;
  for (const EmulatedSideModeConfig& mode : config.side_modes)
    p.side_modes.push_back(MakeSideMode(mode, p.table_mass_kg, random, variation_rel));
  if (config.counterbalance) {
    p.counterbalance_mass_kg = config.counterbalance->moving_mass_kg;
    p.counterbalance_N = config.counterbalance->force_N;
    p.counterbalance_N_m = config.counterbalance->rate_N_mm * 1e3;
  }
  p.temperature = config.temperature;
  p.cascade = config.cascade;
  p.effects = config.effects;
  if (p.cascade.dual_loop_Hz > 0.0 && !(p.scale_counts_per_m > 0.0))
    Refuse(placement.name, "cascade.dual_loop_Hz needs a linear scale (scale_counts_per_mm)");
  ApplyToParameters(p);
  return p;
}

}  // namespace contour::plant
