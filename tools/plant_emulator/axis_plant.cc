#include "tools/plant_emulator/axis_plant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour::plant {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kSlowStep_s = 1e-3;
/// Of the friction level that is left at the least.
constexpr double kSmallestFactor = 0.01;
constexpr double kLongestStep_s = 62.5e-6;
/// Phase per sub-step of the fastest mode: the midpoint rule is off by (omega h)^2 / 12.
constexpr double kPhasePerStep = 0.15;
// Rubber bumpers beyond the stroke, so that an unguarded axis ends there and not in the next room.
constexpr double kBumperClearance_m = 10e-3;
constexpr double kBumperStiffness_N_m = 5e6;
constexpr double kBumperDamping_Ns_m = 5e3;

double At(const Wave& w, double x) noexcept {
  return w.amplitude == 0.0 ? 0.0 : w.amplitude * portable::Sin(w.per_unit * x + w.phase_rad);
}
double Ripple(const RippleTerm& e, double angle_rad) noexcept {
  return e.amplitude_rel * portable::Sin(e.order_per_rev * angle_rad + e.phase_rad);
}
double Ripple(const RippleEffect& e, double angle_rad) noexcept {
  double sum = Ripple(static_cast<const RippleTerm&>(e), angle_rad);
  for (const RippleTerm& term : e.further) sum += Ripple(term, angle_rad);
  return sum;
}
double Cogging_Nm(const CoggingTerm& e, double angle_rad) noexcept {
  return e.amplitude_Nm * portable::Sin(e.order_per_rev * angle_rad + e.phase_rad);
}
/// Constant beyond its ends.
double At(const std::vector<double>& position_mm, const std::vector<double>& value,
          double position_m) noexcept {
  const double x = 1e3 * position_m;
  if (x <= position_mm.front()) return value.front();
  for (std::size_t i = 1; i < position_mm.size(); ++i) {
    const double x0 = position_mm[i - 1], x1 = position_mm[i];
    if (x < x1) return value[i - 1] + (value[i] - value[i - 1]) * (x - x0) / (x1 - x0);
  }
  return value.back();
}
double Sign(double x) noexcept { return static_cast<double>((x > 0.0) - (x < 0.0)); }

double RigidMass_kg(const AxisParameters& p) {
  double mass_kg = p.table_mass_kg + p.counterbalance_mass_kg;
  for (const SideMode& mode : p.side_modes) mass_kg -= mode.mass_kg;
  return mass_kg;
}

}  // namespace

AxisPlant::AxisPlant(const AxisParameters& parameters)
    : p_(parameters),
      friction_(parameters, 1.0 - parameters.motor_friction_share),
      side_modes_(parameters.side_modes, parameters.start_position_m),
      motor_mass_kg_(parameters.motor_inertia_kgm2 / (parameters.radius_m_rad * parameters.radius_m_rad)),
      table_mass_kg_(RigidMass_kg(parameters)),
      motor_m_(parameters.start_position_m),
      table_m_(parameters.start_position_m),
      temperature_degC_(parameters.temperature.start_degC) {
  if (p_.motor_friction_share > 0.0) motor_friction_.emplace(p_, p_.motor_friction_share);
  if (p_.effects.outside) outside_.emplace(*p_.effects.outside, p_.radius_m_rad);
  UpdateSlowThings(0.0);
  ChooseStep();
}

void AxisPlant::ChooseStep() noexcept {
  const double screw = p_.stiffness_N_m * (1.0 / motor_mass_kg_ + 1.0 / table_mass_kg_);
  // Right after a reversal the bristle is twice as stiff (erratum to 2.3).
  double presliding = 2.0 * p_.friction.base.sigma0_N_m / table_mass_kg_;
  if (motor_friction_) presliding += 2.0 * p_.friction.base.sigma0_N_m / motor_mass_kg_;
  double side = 0.0;
  for (const SideMode& m : p_.side_modes) side += m.stiffness_N_m * (1.0 / m.mass_kg + 1.0 / table_mass_kg_);
  max_step_s_ = std::min(kLongestStep_s, kPhasePerStep / std::sqrt(screw + presliding + side));
}

AxisPlant::Contact AxisPlant::ScrewContact(double expected_windup_m) const noexcept {
  const Contact solid{0.0, p_.stiffness_N_m, p_.damping_Ns_m};
  if (!p_.effects.backlash) return solid;
  const double half_gap_m = 0.5e-6 * p_.effects.backlash->gap_um;
  if (std::fabs(expected_windup_m) < half_gap_m) return {};
  return {Sign(expected_windup_m) * half_gap_m, solid.stiffness_N_m, solid.damping_Ns_m};
}

FrictionScale AxisPlant::Scale() const noexcept {
  const double angle = motor_m_ / p_.radius_m_rad;
  double common = slow_factor_ * (1.0 + At(p_.stroke, table_m_));
  if (const auto& e = p_.effects.position_friction)
    common *= 1.0 + e->amplitude_rel *
                        portable::Sin(kTwoPi * e->periods_per_stroke * table_m_ / (2.0 * p_.half_stroke_m) +
                                      e->phase_rad);
  if (const auto& e = p_.effects.friction_map) common *= 1.0 + At(e->position_mm, e->friction_rel, table_m_);
  if (const auto& e = p_.effects.friction_ripple) common *= 1.0 + Ripple(*e, angle);
  if (const auto& e = p_.effects.ball_ripple) common *= 1.0 + Ripple(*e, angle);
  if (const auto& e = p_.effects.load_friction) {
    const double mean_level = 0.5 * (p_.friction.base.plus.Fc_N + p_.friction.base.minus.Fc_N);
    const double load_N = std::fabs(motor_mass_kg_ * motor_m_s2_ + table_mass_kg_ * table_m_s2_);
    common += e->friction_per_torque_rel * load_N / std::max(mean_level, kSmallestLevel_N);
  }
  if (outside_) common = std::max(kSmallestFactor, common + outside_->Level(table_m_, table_m_s_));
  return {common * (1.0 + At(p_.ripple_plus, angle)), common * (1.0 + At(p_.ripple_minus, angle)),
          viscous_factor_};
}

double AxisPlant::DeliveredTorque_Nm(double torque_Nm) const noexcept {
  if (const auto& e = p_.effects.torque_constant) torque_Nm *= e->ratio;
  if (const auto& e = p_.effects.torque_saturation) {
    const double x = torque_Nm / p_.rated_torque_Nm;
    // Falls short with the square; flat where that curve would turn back.
    const double largest = 1.0 / std::sqrt(3.0 * std::max(e->loss_at_rated_rel, 1e-12));
    const double y = std::clamp(x, -largest, largest);
    torque_Nm = p_.rated_torque_Nm * y * (1.0 - e->loss_at_rated_rel * y * y);
  }
  if (const auto& e = p_.effects.torque_ripple)
    torque_Nm *= 1.0 + e->amplitude_rel * portable::Sin(e->order_per_rev * motor_angle_rad() + e->phase_rad);
  return torque_Nm;
}

double AxisPlant::MotorForce_N(double torque_Nm) const noexcept {
  double torque = DeliveredTorque_Nm(torque_Nm);
  if (const auto& e = p_.effects.constant_torque) torque += e->torque_Nm;
  if (const auto& e = p_.effects.cogging) {
    torque += Cogging_Nm(*e, motor_angle_rad());
    for (const CoggingTerm& term : e->further) torque += Cogging_Nm(term, motor_angle_rad());
  }
  return torque / p_.radius_m_rad;
}

double AxisPlant::CounterbalanceForce_N() const noexcept {
  return p_.counterbalance_N - p_.counterbalance_N_m * table_m_;
}

double AxisPlant::TableForce_N() const noexcept {
  double force = coupling_N_ + CounterbalanceForce_N();
  if (outside_) force += outside_->Force_N(table_m_s_);
  if (const auto& e = p_.effects.cable_spring) {
    const double x = table_m_ / p_.half_stroke_m;
    force -= e->torque_at_stroke_end_Nm / p_.radius_m_rad * x * (1.0 + e->hardening_rel * (x * x - 1.0));
  }
  if (const auto& e = p_.effects.periodic_force)
    force +=
        e->amplitude_Nm / p_.radius_m_rad * portable::Sin(kTwoPi * e->frequency_Hz * time_s_ + e->phase_rad);
  if (const auto& e = p_.effects.cutting_force) {
    double since_s = time_s_ - e->start_s;
    if (e->every_s > 0.0 && since_s > 0.0) since_s -= e->every_s * std::floor(since_s / e->every_s);
    if (since_s >= 0.0 && since_s < e->end_s - e->start_s)
      force +=
          e->lag_ms > 0.0 ? e->force_N * (1.0 - portable::Exp(-since_s / (1e-3 * e->lag_ms))) : e->force_N;
  }
  const double beyond_m = std::fabs(table_m_) - p_.half_stroke_m - kBumperClearance_m;
  if (beyond_m > 0.0)
    force -= Sign(table_m_) * kBumperStiffness_N_m * beyond_m + kBumperDamping_Ns_m * table_m_s_;
  return force;
}

namespace {

double ViscousForce_N(const ViscousTerm& e, double speed_rad_s, double radius_m_rad) noexcept {
  const double y = speed_rad_s / e.max_speed_rad_s, knee = e.knee_rad_s / e.max_speed_rad_s;
  const double shape = knee > 0.0 ? y * (1.0 + knee) / (y + knee) : portable::Pow(y, e.exponent);
  return e.torque_at_max_speed_Nm / radius_m_rad * shape;
}

}  // namespace

double AxisPlant::ExtraFriction_N(double velocity_m_s) const noexcept {
  if (velocity_m_s == 0.0) return 0.0;
  double force_N = 0.0;
  if (const auto& e = p_.effects.viscous_nonlinear) {
    const double speed_rad_s = std::fabs(velocity_m_s) / p_.radius_m_rad;
    force_N = ViscousForce_N(*e, speed_rad_s, p_.radius_m_rad);
    for (const ViscousTerm& term : e->further) force_N += ViscousForce_N(term, speed_rad_s, p_.radius_m_rad);
  }
  force_N *= Sign(velocity_m_s);
  // More upwards by as much as it is less downwards: the same force in both.
  if (const auto& e = p_.effects.asymmetric_viscous)
    force_N +=
        0.5 * e->difference_rel * p_.friction.base.sigma2_Ns_m * viscous_factor_ * std::fabs(velocity_m_s);
  return force_N;
}

void AxisPlant::Step(double step_s, double torque_Nm) noexcept {
  const double half_s = 0.5 * step_s;
  const FrictionScale scale = Scale();
  const double motor_force = MotorForce_N(torque_Nm);
  const double table_force = TableForce_N();
  double expected_motor = motor_m_s_ + half_s * motor_m_s2_;
  double expected_table = table_m_s_ + half_s * table_m_s2_;
  double motor_mid = 0.0;
  double table_mid = 0.0;
  // The friction's direction and decay, and the screw's contact, come from the expected velocity. When the
  // solution turns out to move the other way, once more with that.
  for (int pass = 0; pass < 2; ++pass) {
    FrictionLine line = friction_.Line(expected_table, step_s, scale);
    line.constant_N += ExtraFriction_N(expected_table);
    const FrictionLine before_screw =
        motor_friction_ ? motor_friction_->Line(expected_motor, step_s, scale) : FrictionLine{};
    const double windup = motor_m_ - table_m_;
    const Contact screw = ScrewContact(windup + half_s * (expected_motor - expected_table));
    // Mean screw force over the step: k0 + k1 (v_m - v_t), v the step's mean velocities.
    const double k0 = screw.stiffness_N_m * (windup - screw.offset_m);
    const double k1 = screw.stiffness_N_m * half_s + screw.damping_Ns_m;
    const double a11 = motor_mass_kg_ / half_s + k1 + before_screw.slope_Ns_m;
    double a22 = table_mass_kg_ / half_s + k1 + line.slope_Ns_m + p_.counterbalance_N_m * half_s;
    const double b1 = motor_mass_kg_ / half_s * motor_m_s_ + motor_force - k0 - before_screw.constant_N;
    double b2 = table_mass_kg_ / half_s * table_m_s_ + table_force + k0 - line.constant_N;
    side_modes_.AddTo(half_s, table_m_, a22, b2);
    const double determinant = a11 * a22 - k1 * k1;
    motor_mid = (b1 * a22 + k1 * b2) / determinant;
    table_mid = (b2 * a11 + k1 * b1) / determinant;
    const bool turned = (table_mid < 0.0) != (expected_table < 0.0) ||
                        (motor_friction_ && (motor_mid < 0.0) != (expected_motor < 0.0));
    if (!turned && !p_.effects.backlash) break;
    expected_motor = motor_mid;
    expected_table = table_mid;
  }
  friction_.Commit(table_mid);
  if (motor_friction_) motor_friction_->Commit(motor_mid);
  side_modes_.Commit(step_s, table_mid);
  motor_m_s2_ = (motor_mid - motor_m_s_) / half_s;
  table_m_s2_ = (table_mid - table_m_s_) / half_s;
  motor_m_ += step_s * motor_mid;
  table_m_ += step_s * table_mid;
  motor_m_s_ = portable::WithoutDust(motor_m_s_ + step_s * motor_m_s2_);
  table_m_s_ = portable::WithoutDust(table_m_s_ + step_s * table_m_s2_);
  time_s_ += step_s;
  if (outside_) outside_->Advance(step_s, table_m_, table_m_s_);
  UpdateSlowThings(step_s);
}

void AxisPlant::UpdateSlowThings(double step_s) noexcept {
  if (p_.temperature.rise_K_W > 0.0) heat_J_ += step_s * std::fabs(friction_N() * table_m_s_);
  slow_s_ += step_s;
  if (step_s > 0.0 && slow_s_ < kSlowStep_s) return;
  const EmulatedTemperatureConfig& t = p_.temperature;
  const double power_W = slow_s_ > 0.0 ? heat_J_ / slow_s_ : 0.0;
  temperature_degC_ += (t.ambient_degC + t.rise_K_W * power_W - temperature_degC_) *
                       std::min(1.0, slow_s_ / t.time_constant_s);
  slow_s_ = 0.0;
  heat_J_ = 0.0;
  const double above_K = temperature_degC_ - t.reference_degC;
  slow_factor_ = std::max(0.01, 1.0 + p_.friction_temperature_rate_1_K * above_K);
  if (const auto& e = p_.effects.friction_drift) {
    const double done = e->time_constant_s > 0.0 ? 1.0 - portable::Exp(-time_s_ / e->time_constant_s)
                                                 : std::min(1.0, time_s_ / e->over_s);
    slow_factor_ *= 1.0 + e->change_rel * done;
  }
  viscous_factor_ = 1.0;
  if (const auto& e = p_.effects.temperature_viscosity)
    viscous_factor_ = std::max(0.01, 1.0 + e->rate_1_K * above_K);
  if (const auto& e = p_.effects.payload_step; e && time_s_ >= e->time_s) {
    const double rigid_kg = RigidMass_kg(p_);
    table_mass_kg_ =
        std::max(0.05 * rigid_kg, rigid_kg + e->inertia_change_rel * (p_.table_mass_kg + motor_mass_kg_));
    ChooseStep();
  }
}

double AxisPlant::table_position_m() const noexcept {
  double error_um = 0.0;
  if (const auto& map = p_.effects.pitch_map) error_um = At(map->position_mm, map->error_um, table_m_);
  const auto& e = p_.effects.pitch_error;
  if (!e) return table_m_ + 1e-6 * error_um;
  return table_m_ +
         1e-6 * (error_um + e->amplitude_um * portable::Sin(kTwoPi * e->periods_per_stroke * table_m_ /
                                                                (2.0 * p_.half_stroke_m) +
                                                            e->phase_rad));
}

double AxisPlant::friction_N() const noexcept {
  const FrictionScale scale = Scale();
  double force = friction_.Force_N(table_m_s_, scale) + ExtraFriction_N(table_m_s_);
  if (motor_friction_) force += motor_friction_->Force_N(motor_m_s_, scale);
  return force;
}

double AxisPlant::elastic_N() const noexcept {
  return friction_.Elastic_N() + (motor_friction_ ? motor_friction_->Elastic_N() : 0.0);
}

double AxisPlant::energy_J() const noexcept {
  const double windup = motor_m_ - table_m_;
  return 0.5 * (motor_mass_kg_ * motor_m_s_ * motor_m_s_ + table_mass_kg_ * table_m_s_ * table_m_s_ +
                p_.stiffness_N_m * windup * windup) +
         side_modes_.Energy_J(table_m_);
}

void AxisPlant::SetState(double motor_m, double motor_m_s, double table_m, double table_m_s) noexcept {
  motor_m_ = motor_m;
  motor_m_s_ = motor_m_s;
  table_m_ = table_m;
  table_m_s_ = table_m_s;
  motor_m_s2_ = 0.0;
  table_m_s2_ = 0.0;
  side_modes_.Place(table_m, table_m_s);
}

}  // namespace contour::plant
