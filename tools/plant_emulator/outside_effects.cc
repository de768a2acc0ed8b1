#include "tools/plant_emulator/outside_effects.h"

#include <algorithm>
#include <cmath>

namespace contour::plant {

OutsideEffects::OutsideEffects(const OutsideEffectsConfig& config, double radius_m_rad) noexcept
    : c_(config), radius_m_rad_(radius_m_rad), random_(0x0D15EA5E, 7) {}

void OutsideEffects::Advance(double step_s, double table_m, double table_m_s) noexcept {
  const double moved_m = has_last_ ? table_m - last_m_ : 0.0;
  last_m_ = table_m;
  has_last_ = true;
  if (const auto& e = c_.cable_hysteresis) {
    // Elastic, and slack beyond its level: Dahl's law with a travel of millimetres.
    const double level_N = e->torque_Nm / radius_m_rad_;
    const double toward = moved_m > 0.0 ? level_N : -level_N;
    const double share = 1.0 - portable::Exp(-std::fabs(moved_m) / (1e-3 * e->travel_mm));
    cable_N_ += (toward - cable_N_) * share;
  }
  if (const auto& e = c_.lubrication) {
    way_m_ += std::fabs(moved_m);
    if (way_m_ > 1e-3 * e->every_mm) way_m_ = 0.0;
  }
  if (const auto& e = c_.telegraph_torque) {
    until_jump_s_ -= step_s;
    if (until_jump_s_ <= 0.0) {
      telegraph_ = -telegraph_;
      until_jump_s_ = -e->dwell_s * portable::Log(std::max(1e-12, random_.Uniform()));
    }
  }
  static_cast<void>(table_m_s);
}

double OutsideEffects::Level(double table_m, double table_m_s) const noexcept {
  double level = 0.0;
  if (const auto& e = c_.stick_spot; e && table_m_s * e->direction > 0.0) {
    const double x = (table_m - 1e-3 * e->position_mm) / (1e-3 * e->width_mm);
    level += e->amplitude_rel * portable::Exp(-0.5 * x * x);
  }
  if (const auto& e = c_.lubrication) level += e->change_rel * way_m_ / (1e-3 * e->every_mm);
  return level;
}

double OutsideEffects::Force_N(double table_m_s) const noexcept {
  double force = -cable_N_;
  if (const auto& e = c_.telegraph_torque) force += telegraph_ * e->torque_Nm / radius_m_rad_;
  if (const auto& e = c_.speed_band_torque) {
    const double speed = std::fabs(table_m_s) / radius_m_rad_;
    if (speed >= e->speed_low_rad_s && speed <= e->speed_high_rad_s) force += e->torque_Nm / radius_m_rad_;
  }
  return force;
}

}  // namespace contour::plant
