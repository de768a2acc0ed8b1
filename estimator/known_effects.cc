#include "estimator/known_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "estimator/turn.h"

namespace contour {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
/// Friction does not vanish, whatever maps and ripples multiply to.
constexpr double kLeastFactor = 0.05;

}  // namespace

KnownEffects::Table KnownEffects::MakeTable(const char* kind, const std::vector<double>& position_mm,
                                            const std::vector<double>& values, double unit) {
  const std::string name = std::string("extensions.") + kind;
  if (position_mm.empty() || position_mm.size() != values.size())
    throw std::invalid_argument(name + ": the table's lists must be of one length, and not empty");
  Table table;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && !(position_mm[i] > position_mm[i - 1]))
      throw std::invalid_argument(name + ": position_mm must ascend");
    table.x.push_back(1e-3 * position_mm[i]);
    table.y.push_back(unit * values[i]);
  }
  return table;
}

KnownEffects::KnownEffects(const ExtensionsConfig& c, const Mechanics& mechanics, double viscous_Ns_m) {
  neutral_ = !(c.constant_torque || c.cogging || c.friction_ripple || c.ball_ripple || c.cable_spring ||
               c.position_friction || c.pitch_error || c.lead_wobble || c.viscous_nonlinear ||
               c.asymmetric_viscous || c.temperature_viscosity);
  const double r = mechanics.radius_m_rad;
  // Forces of the real machine, in units of the torque that is asked for.
  const double lever_m_rad = r * (c.torque_constant ? c.torque_constant->ratio : 1.0);
  const auto add = [&](double amplitude, double order, double phase_rad, Waves& to) {
    to.push_back({amplitude, order / (kTwoPi * r), phase_rad / kTwoPi});
  };
  const auto add_ripple = [&](const std::optional<RippleExtension>& e, Waves& to) {
    if (!e) return;
    add(e->amplitude_rel, e->order_per_rev, e->phase_rad, to);
    for (const RippleWave& w : e->further) add(w.amplitude_rel, w.order_per_rev, w.phase_rad, to);
  };
  if (const auto& e = c.constant_torque) constant_N_ = e->torque_Nm / lever_m_rad;
  if (const auto& e = c.cogging) {
    add(e->amplitude_Nm / lever_m_rad, e->order_per_rev, e->phase_rad, cogging_);
    for (const CoggingWave& w : e->further)
      add(w.amplitude_Nm / lever_m_rad, w.order_per_rev, w.phase_rad, cogging_);
  }
  add_ripple(c.friction_ripple, ripple_);
  add_ripple(c.ball_ripple, ball_);
  if (const auto& e = c.cable_spring)
    spring_N_ = MakeTable("cable_spring", e->position_mm, e->torque_Nm, 1.0 / lever_m_rad);
  if (const auto& e = c.position_friction)
    friction_rel_ = MakeTable("position_friction", e->position_mm, e->friction_rel, 1.0);
  if (const auto& e = c.pitch_error) pitch_m_ = MakeTable("pitch_error", e->position_mm, e->error_um, 1e-6);
  if (const auto& e = c.lead_wobble) {
    add(1e-6 * e->amplitude_um, e->order_per_rev, e->phase_rad, wobble_);
    for (const WobbleWave& w : e->further) add(1e-6 * w.amplitude_um, w.order_per_rev, w.phase_rad, wobble_);
  }
  const auto add_curve = [&](const ViscousCurve& e) {
    viscous_.push_back({e.torque_at_max_speed_Nm / lever_m_rad, e.max_speed_rad_s * r, e.exponent,
                        e.knee_rad_s / e.max_speed_rad_s});
  };
  if (const auto& e = c.viscous_nonlinear) {
    add_curve(*e);
    for (const ViscousCurve& curve : e->further) add_curve(curve);
  }
  if (const auto& e = c.asymmetric_viscous) viscous_asymmetry_Ns_m_ = 0.5 * e->difference_rel * viscous_Ns_m;
  if (const auto& e = c.temperature_viscosity) {
    viscous_rate_Ns_m_K_ = viscous_Ns_m * e->rate_1_K;
    reference_degC_ = e->reference_degC;
  }
}

double KnownEffects::Table::At(double at) const noexcept {
  if (x.empty()) return 0.0;
  const auto after = std::upper_bound(x.begin(), x.end(), at);
  if (after == x.begin()) return y.front();
  if (after == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(after - x.begin());
  return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
}

double KnownEffects::Wave::At(double position_m) const noexcept {
  return amplitude == 0.0 ? 0.0 : amplitude * Turn(position_m * turns_1_m + phase_turns).sin;
}

double KnownEffects::Sum(const Waves& waves, double position_m) noexcept {
  double sum = 0.0;
  for (const Wave& wave : waves) sum += wave.At(position_m);
  return sum;
}

double KnownEffects::MotorForce_N(double position_m) const noexcept {
  return constant_N_ + Sum(cogging_, position_m);
}

double KnownEffects::LevelFactor(double position_m) const noexcept {
  const double factor = (1.0 + friction_rel_.At(position_m)) * (1.0 + Sum(ripple_, position_m)) *
                        (1.0 + Sum(ball_, position_m));
  return std::max(factor, kLeastFactor);
}

double KnownEffects::Curve::At(double velocity_m_s) const noexcept {
  const double u = std::abs(velocity_m_s) / max_speed_m_s;
  const double curve = knee > 0.0        ? u * (1.0 + knee) / (u + knee)
                       : exponent == 2.0 ? u * u
                                         : std::pow(u, exponent);
  return std::copysign(force_N * curve, velocity_m_s);
}

double KnownEffects::Viscous_N(double velocity_m_s, double temperature_degC) const noexcept {
  double force_N = viscous_asymmetry_Ns_m_ * std::abs(velocity_m_s);
  for (const Curve& curve : viscous_) force_N += curve.At(velocity_m_s);
  if (viscous_rate_Ns_m_K_ != 0.0 && !std::isnan(temperature_degC))
    force_N += viscous_rate_Ns_m_K_ * (temperature_degC - reference_degC_) * velocity_m_s;
  return force_N;
}

double KnownEffects::Lead_m(double position_m) const noexcept {
  return -pitch_m_.At(position_m) - Sum(wobble_, position_m);
}

}  // namespace contour
