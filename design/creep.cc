#include "design/creep.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

#include "design/loop_margins.h"
#include "design/loop_member.h"
#include "design/loop_plant.h"

namespace contour {
namespace {

// Of the fastest swing of motor and table, and of the period.
constexpr double kStepsPerSwing = 40.0;
constexpr double kStepsPerPeriod = 8.0;
// Of the slowest time constant: what is left of a settling after it is below a hundredth, and what grows has
// come from the kick's size to where it ends.
constexpr double kTimeConstants = 5.0;
// What takes longer to settle or to grow is looked at as if it took so many periods: the simulation has to
// end.
constexpr double kLongest_periods = 2000.0;
// In Stribeck velocities: where the slope has faded.
constexpr double kFast = 10.0;
// Of what friction winds its screw up by an axis may move by this share at rest, as every one may; and by all
// of it while it settles, which is what its reversals cost it anyway.
constexpr double kRestShare = 0.2;
constexpr double kStopShare = 1.0;
constexpr double kLeastFriction = 0.1;
constexpr double kTurn = 2.0 * std::numbers::pi;

double Coulomb_N(const Friction& f) { return 0.5 * (f.Fc_plus_N + f.Fc_minus_N); }

/// As far as they do in steady sliding.
double Bends_m(const Friction& f) { return Coulomb_N(f) / f.sigma0_N_m; }

/// LuGre's law, of both directions' mean.
class Bristles {
 public:
  Bristles(const Friction& f, double share)
      : f_(f),
        share_(share),
        coulomb_N_(Coulomb_N(f)),
        rise_N_(0.5 * (f.Fs_plus_N + f.Fs_minus_N) - coulomb_N_) {}
  [[nodiscard]] double Steady_N(double v_m_s) const { return share_ * Level_N(v_m_s); }
  void SlideAt(double v_m_s) { bent_m_ = Level_N(v_m_s) / f_.sigma0_N_m; }
  double Step_N(double v_m_s, double dt_s) {
    const double decay_1_s = f_.sigma0_N_m * std::fabs(v_m_s) / Level_N(v_m_s);
    const double bent_m = (bent_m_ + v_m_s * dt_s) / (1.0 + decay_1_s * dt_s);
    const double rate_m_s = (bent_m - bent_m_) / dt_s;
    bent_m_ = bent_m;
    const double sigma1_Ns_m = f_.sigma1_Ns_m * std::exp(-std::pow(v_m_s / f_.sigma1_decay_m_s, 2));
    return share_ * (f_.sigma0_N_m * bent_m + sigma1_Ns_m * rate_m_s);
  }

 private:
  [[nodiscard]] double Level_N(double v_m_s) const {
    return coulomb_N_ + rise_N_ * std::exp(-std::pow(std::fabs(v_m_s) / f_.vs_m_s, f_.stribeck_exponent));
  }
  Friction f_;
  double share_, coulomb_N_, rise_N_;
  double bent_m_ = 0.0;
};

/// Commands under way: which of them acts in a step of the period.
class Delay {
 public:
  Delay(const TwoInertiaAxis& a, double period_s, int steps, double before_N) {
    const double periods = std::max(0.0, a.delay_cycles + a.dead_time_s / period_s);
    const double whole = std::floor(periods + 1e-9);
    late_steps_ = static_cast<int>(std::lround((periods - whole) * steps));
    commands_.assign(static_cast<std::size_t>(whole) + 2, before_N);
  }
  void Send(double command_N) {
    commands_.push_back(command_N);
    commands_.pop_front();
  }
  [[nodiscard]] double At(int step) const { return commands_[step < late_steps_ ? 0 : 1]; }

 private:
  std::deque<double> commands_;
  int late_steps_ = 0;
};

/// From top to bottom of what is put in.
class Swing {
 public:
  void Put(double error_m) {
    low_m_ = std::min(low_m_, error_m);
    high_m_ = std::max(high_m_, error_m);
  }
  [[nodiscard]] double size_m() const { return high_m_ - low_m_; }

 private:
  double low_m_ = std::numeric_limits<double>::infinity();
  double high_m_ = -std::numeric_limits<double>::infinity();
};

/// In which what a loop does on one member dies down or grows by a factor of e.
double TimeConstant_s(const LoopMember& member, const TwoInertiaLoop& loop, double period_s) {
  const double per_period = std::fabs(std::log(GrowthOn(member, loop, period_s)));
  // Also where it is not a number.
  return per_period * kLongest_periods > 1.0 ? period_s / per_period : kLongest_periods * period_s;
}

/// 1 / s, of motor and table, each held by its bristles; and what the bristles' damping takes speed by.
double Fastest_1_s(const TwoInertiaAxis& m, const Friction& f) {
  const double motor_1_s2 = (m.stiffness_N_m + f.motor_share * f.sigma0_N_m) / m.motor_mass_kg;
  const double table_1_s2 = (m.stiffness_N_m + (1.0 - f.motor_share) * f.sigma0_N_m) / m.table_mass_kg;
  const double swing_1_s2 = 0.5 * (motor_1_s2 + table_1_s2) +
                            std::hypot(0.5 * (motor_1_s2 - table_1_s2),
                                       m.stiffness_N_m / std::sqrt(m.motor_mass_kg * m.table_mass_kg));
  return std::max({std::sqrt(swing_1_s2), f.motor_share * f.sigma1_Ns_m / m.motor_mass_kg,
                   (1.0 - f.motor_share) * f.sigma1_Ns_m / m.table_mass_kg});
}

Friction Times(Friction f, double factor) {
  for (double* v : {&f.Fs_plus_N, &f.Fs_minus_N, &f.Fc_plus_N, &f.Fc_minus_N, &f.sigma0_N_m, &f.sigma1_Ns_m})
    *v *= factor;
  return f;
}

}  // namespace

CreepTimes TimesOf(const LoopAxis& a, const TwoInertiaLoop& loop, double period_s, double speed_m_s) {
  const double creeping_s = TimeConstant_s(CreepingMember(a, speed_m_s), loop, period_s);
  const double sliding_s = TimeConstant_s(SlidingMember(a), loop, period_s);
  const double resting_s = TimeConstant_s(RestingMember(a), loop, period_s);
  // Sticking and slipping, bristles bend one way and the other, and the loop swings.
  const double swings_s =
      kTurn * sliding_s + std::min(2.0 * Bends_m(a.friction) / speed_m_s, kLongest_periods * period_s);
  return {kTimeConstants * creeping_s + swings_s, swings_s,
          std::max(kTimeConstants * resting_s, kStandsAfter_s), kTurn * sliding_s + resting_s};
}

Creep CreepAt(const LoopAxis& a, const TwoInertiaLoop& loop, double period_s, double speed_m_s,
              double friction_rel) {
  const TwoInertiaAxis& m = a.axis;
  const double unit_N = (m.motor_mass_kg + m.table_mass_kg) / (period_s * period_s);
  const LinearSystem controller = MakeController(loop, unit_N);
  LoopMatrix state = LoopMatrix::Zero(controller.a.rows(), 1), y = LoopMatrix::Zero(2, 1);

  const Friction friction = Times(a.friction, friction_rel);
  Bristles table(friction, 1.0 - friction.motor_share), motor(friction, friction.motor_share);
  const double table_N = table.Steady_N(speed_m_s) + m.viscous_Ns_m * speed_m_s;
  const double fed_N = table_N + motor.Steady_N(speed_m_s);
  const double lead_m = table_N / m.stiffness_N_m;

  const auto steps = static_cast<int>(
      std::ceil(std::max(kStepsPerPeriod, kStepsPerSwing * Fastest_1_s(m, friction) * period_s / kTurn)));
  const double dt_s = period_s / steps;
  const double follows = m.lag_s > 0.0 ? 1.0 - std::exp(-dt_s / m.lag_s) : 1.0;
  Delay delay(m, period_s, steps, fed_N);
  // It begins in steady sliding, behind by as much as the bristles bend.
  table.SlideAt(speed_m_s);
  motor.SlideAt(speed_m_s);
  double p2 = -Bends_m(friction), v2 = speed_m_s, p1 = p2 + lead_m, v1 = speed_m_s, force_N = fed_N;
  Swing creeping, stopping, resting;
  const CreepTimes times = TimesOf(a, loop, period_s, speed_m_s);
  const double stops_s = times.creeps_s + times.looks_creeping_s,
               ends_s = stops_s + times.rests_s + times.looks_resting_s;
  const auto cycles = static_cast<int>(ends_s / period_s);
  for (int i = 0; i < cycles; ++i) {
    const double time_s = i * period_s;
    const double wanted_m = speed_m_s * std::min(time_s, stops_s);
    y << p1 - wanted_m - lead_m, p2 - wanted_m;
    const double command_N = (controller.c * state + controller.d * y)(0, 0) * unit_N + fed_N;
    state = (controller.a * state + controller.b * y).eval();
    delay.Send(std::clamp(command_N, -a.most_force_N, a.most_force_N));
    for (int j = 0; j < steps; ++j) {
      force_N += (delay.At(j) - force_N) * follows;
      const double screw_N = m.stiffness_N_m * (p1 - p2) + m.damping_Ns_m * (v1 - v2);
      v1 += dt_s * (force_N - screw_N - motor.Step_N(v1, dt_s)) / m.motor_mass_kg;
      v2 += dt_s * (screw_N - table.Step_N(v2, dt_s) - m.viscous_Ns_m * v2) / m.table_mass_kg;
      p1 += dt_s * v1;
      p2 += dt_s * v2;
    }
    if (time_s < stops_s && time_s >= times.creeps_s) creeping.Put(p2 - wanted_m);
    if (time_s >= stops_s + kStandsAfter_s) stopping.Put(p2 - wanted_m);
    if (time_s >= ends_s - times.looks_resting_s) resting.Put(p2 - wanted_m);
  }
  return {speed_m_s, creeping.size_m(), stopping.size_m(), resting.size_m()};
}

namespace {

StickSlip Limits(const LoopAxis& axis) {
  const double wind_up_m = Coulomb_N(axis.friction) / axis.axis.stiffness_N_m;
  StickSlip out;
  out.most_rest_m = kRestShare * wind_up_m;
  out.most_stop_m = kStopShare * wind_up_m;
  return out;
}

std::vector<double> Speeds_m_s(const LoopAxis& axis) {
  std::vector<double> speeds = SlopeSpeeds_m_s(axis);
  speeds.push_back(kFast * axis.friction.vs_m_s);
  return speeds;
}

void Put(const Creep& c, double bends_m, StickSlip& out) {
  // What is not a number has run away.
  const auto size_m = [](double swing_m) {
    return swing_m >= 0.0 ? swing_m : std::numeric_limits<double>::infinity();
  };
  out.rest_m = std::max(out.rest_m, size_m(c.rest_m));
  out.stop_m = std::max(out.stop_m, size_m(c.stop_m));
  if (size_m(c.swing_m) > out.swing_m) {
    out.swing_m = size_m(c.swing_m);
    out.at_m_s = c.speed_m_s;
  }
  if (size_m(c.swing_m) <= bends_m) return;
  out.slowest_m_s = out.Sticks() ? std::min(out.slowest_m_s, c.speed_m_s) : c.speed_m_s;
  out.fastest_m_s = std::max(out.fastest_m_s, c.speed_m_s);
}

}  // namespace

StickSlip StickSlipOf(const LoopAxis& axis, const TwoInertiaLoop& loop, double period_s) {
  StickSlip out = Limits(axis);
  for (const double off : {-axis.friction_std, 0.0, axis.friction_std})
    for (const double speed_m_s : Speeds_m_s(axis))
      Put(CreepAt(axis, loop, period_s, speed_m_s, std::max(1.0 + off, kLeastFriction)),
          Bends_m(axis.friction), out);
  return out;
}

StickSlip RestAfterStops(const LoopAxis& axis, const TwoInertiaLoop& loop, double period_s) {
  StickSlip out = Limits(axis);
  for (const double off : {0.0, axis.friction_std, -axis.friction_std}) {
    for (const double speed_m_s : Speeds_m_s(axis)) {
      Put(CreepAt(axis, loop, period_s, speed_m_s, std::max(1.0 + off, kLeastFriction)),
          Bends_m(axis.friction), out);
      if (!out.ComesToRest()) return out;
    }
  }
  return out;
}

}  // namespace contour
