#include "tools/validation/hidden/draw_setting.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/plant_emulator/random.h"
#include "tools/validation/hidden/excitation.h"
#include "tools/validation/hidden/machine_text.h"
#include "tools/validation/hidden/specimens.h"

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

diagnosis::SpecimenNeeds NeedsOf(const std::vector<std::string>& kinds) {
  diagnosis::SpecimenNeeds all;
  for (const std::string& kind : kinds) {
    const diagnosis::Specimen* specimen = SpecimenOf(kind);
    if (specimen == nullptr) continue;
    const diagnosis::SpecimenNeeds& n = specimen->needs;
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

Setting DrawSetting(std::uint64_t seed, const std::vector<std::string>& kinds, Misfit misfit, Length length) {
  plant::Random r(seed, kSettingStream);
  const diagnosis::SpecimenNeeds needs = NeedsOf(kinds);
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
  const diagnosis::SpecimenMachine machine = MachineOf(s);
  Hidden h;
  h.kind = kind;
  h.phase_rad = r.Uniform(0.0, kTwoPi);
  const double sign = r.Uniform() < 0.5 ? -1.0 : 1.0;
  if (const diagnosis::Specimen* specimen = SpecimenOf(kind)) {
    const diagnosis::Drawn drawn = (*specimen->draw)(machine, sign, [&] { return r.Uniform(); });
    h.size = drawn.size;
    h.order = drawn.order;
    h.second = drawn.second;
    return h;
  }
  if (kind == "stick_spot") {
    h.size = 0.5;
    h.order = r.Uniform(-0.5, 0.5);  // place, of the half stroke
    h.second = sign;                 // direction
  }
  if (kind == "cable_hysteresis" || kind == "telegraph_torque" || kind == "speed_band_torque")
    h.size = 0.1 * machine.friction_Nm;
  if (kind == "speed_band_torque") h.second = r.Uniform(0.2, 0.5);
  if (kind == "lubrication") h.size = 0.2;
  return h;
}

}  // namespace contour::hidden
