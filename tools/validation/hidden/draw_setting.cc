#include "tools/validation/hidden/draw_setting.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/plant_emulator/random.h"
#include "tools/validation/hidden/excitation.h"
#include "tools/validation/hidden/machine_text.h"

namespace contour::hidden {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::uint64_t kSettingStream = 1;
constexpr std::uint64_t kEffectStream = 2;
constexpr std::uint64_t kLawStream = 3;
/// What the stated uncertainties are, relative, and how far beyond one of them a truth may lie.
constexpr double kInertia = 0.05, kStiffness = 0.1, kFc = 0.1, kFs = 0.1, kVs = 0.2, kS0 = 0.2, kS1 = 0.3,
                 kS2 = 0.15, kLag = 0.1;
constexpr double kTruncation = 2.0;

double LogUniform(plant::Random& r, double low, double high) {
  return low * std::exp(r.Uniform() * std::log(high / low));
}

double Near(plant::Random& r, double stated, double sigma_rel) {
  double n = r.Normal();
  while (std::abs(n) > kTruncation) n = r.Normal();
  return stated * (1.0 + sigma_rel * n);
}

/// Periods over the emulated stroke that are one or two over the travel of the program: the shape then has no
/// mean there, which would be part of the friction level (or of the scale's zero) and not of the shape.
double WholePeriods(plant::Random& r, const Setting& s) {
  return (r.Uniform() < 0.5 ? 1.0 : 2.0) * EmulatedStroke_mm(s.truth) / (2.0 * s.truth.half_stroke_mm);
}

}  // namespace

double ShareOf(Strength strength) {
  switch (strength) {
    case Strength::kClear:
      return 0.55;
    case Strength::kModerate:
      return 0.13;
    case Strength::kBarely:
      break;
  }
  return 0.02;
}

const char* Name(Strength strength) {
  return strength == Strength::kClear ? "clear" : strength == Strength::kModerate ? "moderate" : "barely";
}

const char* Name(Misfit misfit) {
  switch (misfit) {
    case Misfit::kNone:
      return "none";
    case Misfit::kMaxwellSlip:
      return "maxwell_slip";
    case Misfit::kTimingError:
      return "timing_30us";
    case Misfit::kNoiseLevel:
      return "noise_level";
    case Misfit::kDelayAndLag:
      break;
  }
  return "delay_and_lag";
}

const char* Name(Length length) { return length == Length::kLong ? "long" : "short"; }

double TrueAxis::radius_m_rad() const { return lead_mm * 1e-3 / kTwoPi; }
double TrueAxis::vs_rad_s() const { return vs_mm_s * 1e-3 / radius_m_rad(); }

namespace {

Needs NeedsOf(const std::vector<std::string>& kinds) {
  Needs all;
  for (const std::string& kind : kinds) {
    const Needs n = hidden::NeedsOf(kind);
    all.scale |= n.scale;
    all.temperature |= n.temperature;
    all.second_axis |= n.second_axis;
    all.no_stribeck |= n.no_stribeck;
    all.rigid |= n.rigid;
    all.two_inertia |= n.two_inertia;
  }
  if (all.rigid && all.two_inertia)
    throw std::runtime_error("one effect needs a model without a screw, the other one with it");
  return all;
}

}  // namespace

Needs NeedsOf(const std::string& kind) {
  Needs n;
  n.scale = kind == "pitch_error";
  n.temperature = kind == "temperature_viscosity";
  n.second_axis = kind == "cross_coupling";
  n.no_stribeck = kind == "stribeck";
  n.rigid = kind == "compliance";
  n.two_inertia = kind == "backlash";
  return n;
}

Setting DrawSetting(std::uint64_t seed, const std::vector<std::string>& kinds, Misfit misfit, Length length) {
  plant::Random r(seed, kSettingStream);
  const Needs needs = NeedsOf(kinds);
  Setting s;
  s.seed = seed;
  s.misfit = misfit;
  s.length = length;
  TrueAxis& m = s.stated;
  m.lead_mm = r.Uniform() < 0.5 ? 5.0 : 10.0;
  m.motor_inertia_kgm2 = LogUniform(r, 3e-5, 1e-4);
  m.table_mass_kg = LogUniform(r, 5.0, 15.0);
  m.rated_torque_Nm = 0.637;
  m.Fc_N = LogUniform(r, 25.0, 60.0) * 5.0 / m.lead_mm;
  m.Fs_N = m.Fc_N * (needs.no_stribeck ? 1.0 : r.Uniform(1.15, 1.5));
  m.vs_mm_s = LogUniform(r, 1.0, 4.0);
  // The paper's or Gauss's; of its own stream, so that nothing else of a seed depends on it.
  m.stribeck_exponent = plant::Random(seed, kLawStream).Uniform() < 0.5 ? 1 : 2;
  m.sigma0_N_m = LogUniform(r, 2e6, 1e7);
  m.sigma1_Ns_m = LogUniform(r, 1000.0, 4000.0);
  m.sigma1_decay_mm_s = 2.0;
  m.sigma2_Ns_m = LogUniform(r, 150.0, 600.0);
  s.rigid = needs.rigid || (!needs.two_inertia && r.Uniform() < 0.5);
  // A stiff screw is a rigid axis as far as a log can tell; a soft one has its mode at 250 to 400 Hz.
  m.stiffness_N_um = s.rigid ? 40.0 * m.table_mass_kg
                             : 1e-6 * m.table_mass_kg * std::pow(kTwoPi * r.Uniform(220.0, 380.0), 2);
  m.damping_Ns_m = 0.03 * 2.0 * std::sqrt(m.stiffness_N_um * 1e6 * m.table_mass_kg);
  m.lag_ms = 0.2;
  const double encoders[] = {1048576.0, 131072.0, 65536.0};
  m.encoder_counts_per_rev = encoders[static_cast<std::size_t>(3.0 * r.Uniform())];
  const bool scale = r.Uniform() < 0.5;
  m.scale_counts_per_mm = needs.scale || scale ? 1000.0 : 0.0;
  m.torque_noise_Nm = m.rated_torque_Nm * LogUniform(r, 0.002, 0.006);
  s.temperature = needs.temperature || r.Uniform() < 0.5;
  s.second_axis = needs.second_axis;

  s.truth = s.stated;
  TrueAxis& t = s.truth;
  t.motor_inertia_kgm2 = Near(r, m.motor_inertia_kgm2, kInertia);
  t.table_mass_kg = Near(r, m.table_mass_kg, kInertia);
  t.stiffness_N_um = Near(r, m.stiffness_N_um, kStiffness);
  t.Fc_N = Near(r, m.Fc_N, kFc);
  t.Fs_N = needs.no_stribeck ? t.Fc_N : std::max(t.Fc_N, Near(r, m.Fs_N, kFs));
  t.vs_mm_s = Near(r, m.vs_mm_s, kVs);
  t.sigma0_N_m = Near(r, m.sigma0_N_m, kS0);
  t.sigma1_Ns_m = Near(r, m.sigma1_Ns_m, kS1);
  t.sigma2_Ns_m = Near(r, m.sigma2_Ns_m, kS2);
  t.lag_ms = Near(r, m.lag_ms, kLag);
  if (misfit == Misfit::kDelayAndLag) t.lag_ms = 1.2 * m.lag_ms;
  s.program = ExcitationProgram(r, s);
  return s;
}

Hidden DrawEffect(std::uint64_t seed, const std::string& kind, const Setting& s) {
  plant::Random r(seed, kEffectStream);
  const double friction_Nm = s.truth.Fc_N * s.truth.radius_m_rad();
  Hidden h;
  h.kind = kind;
  h.phase_rad = r.Uniform(0.0, kTwoPi);
  const double sign = r.Uniform() < 0.5 ? -1.0 : 1.0;
  if (kind == "asymmetric_coulomb") h.size = sign * 0.05;
  if (kind == "constant_torque") h.size = sign * 0.05 * friction_Nm;
  if (kind == "stribeck") {
    h.size = 0.2;  // Fs / Fc - 1
    h.second = s.truth.vs_rad_s();
  }
  if (kind == "position_friction") {
    h.size = 0.1;
    h.order = WholePeriods(r, s);
  }
  if (kind == "cable_spring") h.size = 0.1 * friction_Nm;
  if (kind == "friction_ripple") {
    h.size = 0.05;
    h.order = 1.0 + std::floor(4.0 * r.Uniform());
  }
  if (kind == "ball_ripple") {
    h.size = 0.05;
    h.order = 0.3 + 0.15 * r.Uniform() + std::floor(3.0 * r.Uniform());
  }
  if (kind == "cogging") {
    h.size = 0.05 * friction_Nm;
    const double orders[] = {4.0, 6.0, 8.0, 12.0, 24.0};
    h.order = orders[static_cast<std::size_t>(5.0 * r.Uniform())];
  }
  if (kind == "viscous_nonlinear") {
    h.size = sign * 0.1 * friction_Nm;
    h.order = r.Uniform(1.7, 2.3);
  }
  if (kind == "temperature_viscosity") h.size = -0.01;
  if (kind == "friction_drift") {
    h.size = sign * 0.1;
    h.second = r.Uniform() < 0.5 ? 0.0 : r.Uniform(10.0, 30.0);  // time constant
  }
  if (kind == "torque_constant") h.size = sign;  // the strength decides
  if (kind == "torque_saturation") h.size = 0.02;
  if (kind == "payload_step") {
    h.size = sign * 0.05;
    h.second = r.Uniform(0.35, 0.65);  // of the log
  }
  if (kind == "compliance") {
    h.size = 1.0 / 300.0;  // 1 / antiresonance
    h.second = r.Uniform(0.02, 0.05);
  }
  if (kind == "backlash") h.size = 2.0;
  if (kind == "presliding_hysteresis") {
    h.size = 0.1;
    h.second = r.Uniform(0.05, 0.2);
  }
  if (kind == "input_delay") h.size = 100.0;
  if (kind == "current_lag") h.size = 100.0;
  if (kind == "encoder_eccentricity") h.size = 1e-3;
  if (kind == "encoder_subdivision") {
    h.size = 1e-5;
    const double orders[] = {32.0, 64.0, 128.0, 256.0};
    h.order = orders[static_cast<std::size_t>(4.0 * r.Uniform())];
  }
  if (kind == "pitch_error") {
    h.size = 1.0;
    h.order = WholePeriods(r, s);
  }
  if (kind == "cross_coupling") h.size = sign * 1e-3;
  if (kind == "load_friction") h.size = 0.05;
  if (kind == "periodic_force") {
    h.size = 0.05 * friction_Nm;
    h.order = LogUniform(r, 7.0, 70.0);
  }
  if (kind == "sample_jitter") h.size = 2.0;
  // Outside the catalogue.
  if (kind == "stick_spot") {
    h.size = 0.5;
    h.order = r.Uniform(-0.5, 0.5);  // place, of the half stroke
    h.second = sign;                 // direction
  }
  if (kind == "cable_hysteresis" || kind == "telegraph_torque" || kind == "speed_band_torque")
    h.size = 0.1 * friction_Nm;
  if (kind == "speed_band_torque") h.second = r.Uniform(0.2, 0.5);
  if (kind == "lubrication") h.size = 0.2;
  return h;
}

}  // namespace contour::hidden
