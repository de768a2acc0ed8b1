#include "tests/analysis/support/known_axis.h"

#include <cmath>

namespace contour::diagnosis::test {
namespace {

using std::numbers::pi;

double TimeOf(std::size_t row) { return KnownAxis::kPeriod_s * static_cast<double>(row); }
/// Of the table, from the middle of the stroke.
double TravelAt(double time_s) { return KnownAxis::kHalfStroke_m * std::sin(pi * time_s); }

AxisLog LogOf(const KnownOptions& options) {
  AxisLog log;
  log.axis = "x";
  log.linear = options.linear;
  log.period_s = KnownAxis::kPeriod_s;
  log.rows = KnownAxis::kRows;
  log.present.assign(KnownAxis::kRows, 1);
  log.command.assign(KnownAxis::kRows, 0.0);
  for (std::size_t k = 0; k < KnownAxis::kRows; ++k) {
    const double table_m = KnownAxis::kMiddle_m + TravelAt(TimeOf(k));
    log.position.push_back(options.linear ? table_m : table_m / KnownAxis::kTablePerRad);
    if (options.scale) log.table_position_m.push_back(table_m);
    if (options.temperature) log.temperature_degC.push_back(24.0 + TimeOf(k));
    if (options.axis2) log.axis2_position_m.push_back(0.0);
  }
  return log;
}

StatedAxis StatedOf(const KnownOptions& o) {
  StatedAxis s;
  const double R = KnownAxis::kTablePerRad;
  const double force = o.linear ? 1.0 / R : 1.0, length = o.linear ? R : 1.0;
  s.axis = "x";
  s.linear = o.linear;
  s.lead_m = 0.01;
  s.table_per_q = o.linear ? 1.0 : R;
  s.two_inertia = o.two_inertia;
  s.friction_on_load = o.friction_on_load;
  const double inertia = force / length;
  s.motor_inertia = (o.two_inertia ? 6e-5 : 1e-4) * inertia;
  s.load_inertia = o.two_inertia ? 4e-5 * inertia : 0.0;
  s.stiffness = o.two_inertia ? s.load_inertia * std::pow(2.0 * pi * 100.0, 2) : 0.0;
  s.damping = o.two_inertia ? 0.1 * 2.0 * pi * 100.0 * s.load_inertia : 0.0;
  StatedFriction& f = s.friction;
  f.Fc_plus = 0.06 * force;
  f.Fc_minus = 0.04 * force;
  f.Fs_plus = (o.stribeck ? 1.5 : 1.0) * f.Fc_plus;
  f.Fs_minus = (o.stribeck ? 1.5 : 1.0) * f.Fc_minus;
  f.vs = 2.0 * length;
  f.s0 = 5.0 * force / length;
  f.s1 = 5e-3 * force / length;
  f.s2 = 2e-4 * force / length;
  s.delay_s = 1e-3;
  s.lag_s = 2e-4;
  s.position_step = 5e-5 * length;
  s.command_step = 1e-3 * 0.64 * force;
  s.rated = 0.64 * force;
  s.stroke_min_m = -0.1;
  s.stroke_max_m = 0.1;
  return s;
}

void Fill(const KnownOptions& o, const StatedAxis& stated, Signals& s) {
  const double per_q = stated.table_per_q;
  s.half_stroke_m = KnownAxis::kHalfStroke_m;
  s.middle_m = KnownAxis::kMiddle_m;
  s.max_speed = KnownAxis::kTopSpeed_m_s / per_q;
  s.angle_per_q = o.linear ? 1.0 / KnownAxis::kTablePerRad : 1.0;
  s.coulomb = 0.5 * (stated.friction.Fc_plus + stated.friction.Fc_minus);
  const std::size_t n = KnownAxis::kRows;
  for (Signal* signal : {&s.position, &s.velocity, &s.acceleration, &s.table_m, &s.angle_rad, &s.sign,
                         &s.model_torque, &s.net_force})
    signal->assign(n, 0.0);
  for (Signal* signal : {&s.temperature_K, &s.axis2_m_s2, &s.axis2_m_s}) signal->clear();
  s.mean_degC = 25.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = TimeOf(k), speed_m_s = KnownAxis::kTopSpeed_m_s * std::cos(pi * t);
    s.table_m[k] = TravelAt(t);
    s.position[k] = (KnownAxis::kMiddle_m + s.table_m[k]) / per_q;
    s.angle_rad[k] = (KnownAxis::kMiddle_m + s.table_m[k]) / KnownAxis::kTablePerRad;
    s.velocity[k] = speed_m_s / per_q;
    s.acceleration[k] = -pi * pi * s.table_m[k] / per_q;
    s.sign[k] = speed_m_s > 0.0 ? 1.0 : -1.0;
    s.net_force[k] = (stated.motor_inertia + stated.load_inertia) * s.acceleration[k];
    s.model_torque[k] = s.net_force[k] + s.sign[k] * s.coulomb;
    if (o.temperature) s.temperature_K.push_back(t - 1.0);
    if (o.axis2) s.axis2_m_s2.push_back(4.0 * std::sin(7.0 * t));
    if (o.axis2) s.axis2_m_s.push_back(-4.0 / 7.0 * std::cos(7.0 * t));
  }
}

}  // namespace

KnownAxis::KnownAxis(const KnownOptions& options)
    : log(LogOf(options)), stated(StatedOf(options)), problem(log, stated, 1) {
  Fill(options, stated, *problem.signals);
}

}  // namespace contour::diagnosis::test
