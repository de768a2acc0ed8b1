#include "estimator/known_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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
               c.position_friction || c.pitch_error || c.viscous_nonlinear || c.temperature_viscosity);
  const double r = mechanics.radius_m_rad;
  const auto wave = [&](double amplitude, double order, double phase_rad) {
    return Wave{amplitude, order / (kTwoPi * r), phase_rad / kTwoPi};
  };
  if (const auto& e = c.constant_torque) constant_N_ = e->torque_Nm / r;
  if (const auto& e = c.cogging) cogging_ = wave(e->amplitude_Nm / r, e->order_per_rev, e->phase_rad);
  if (const auto& e = c.friction_ripple) ripple_ = wave(e->amplitude_rel, e->order_per_rev, e->phase_rad);
  if (const auto& e = c.ball_ripple) ball_ = wave(e->amplitude_rel, e->order_per_rev, e->phase_rad);
  if (const auto& e = c.cable_spring)
    spring_N_ = MakeTable("cable_spring", e->position_mm, e->torque_Nm, 1.0 / r);
  if (const auto& e = c.position_friction)
    friction_rel_ = MakeTable("position_friction", e->position_mm, e->friction_rel, 1.0);
  if (const auto& e = c.pitch_error) pitch_m_ = MakeTable("pitch_error", e->position_mm, e->error_um, 1e-6);
  if (const auto& e = c.viscous_nonlinear) {
    viscous_N_ = e->torque_at_max_speed_Nm / r;
    max_speed_m_s_ = e->max_speed_rad_s * r;
    exponent_ = e->exponent;
    knee_ = e->knee_rad_s / e->max_speed_rad_s;
  }
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

double KnownEffects::Force_N(double position_m) const noexcept {
  return constant_N_ + cogging_.At(position_m) + spring_N_.At(position_m);
}

double KnownEffects::LevelFactor(double position_m) const noexcept {
  const double factor =
      (1.0 + friction_rel_.At(position_m)) * (1.0 + ripple_.At(position_m)) * (1.0 + ball_.At(position_m));
  return std::max(factor, kLeastFactor);
}

double KnownEffects::Viscous_N(double velocity_m_s, double temperature_degC) const noexcept {
  double force_N = 0.0;
  if (viscous_N_ != 0.0) {
    const double u = std::abs(velocity_m_s) / max_speed_m_s_;
    const double curve = knee_ > 0.0        ? u * (1.0 + knee_) / (u + knee_)
                         : exponent_ == 2.0 ? u * u
                                            : std::pow(u, exponent_);
    force_N = std::copysign(viscous_N_ * curve, velocity_m_s);
  }
  if (viscous_rate_Ns_m_K_ != 0.0 && !std::isnan(temperature_degC))
    force_N += viscous_rate_Ns_m_K_ * (temperature_degC - reference_degC_) * velocity_m_s;
  return force_N;
}

double KnownEffects::Lead_m(double position_m) const noexcept { return -pitch_m_.At(position_m); }

}  // namespace contour
