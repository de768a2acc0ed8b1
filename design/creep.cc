#include "design/creep.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "design/loop_member.h"
#include "design/loop_plant.h"

namespace contour {
namespace {

// Of the screw's mode, and of the period.
constexpr double kStepsPerSwing = 40.0;
constexpr double kStepsPerPeriod = 8.0;
// A loop of some hertz has settled by then, or swings.
constexpr double kCreeps_s = 3.0;
constexpr double kRests_s = 4.0;
constexpr double kLooksFor_s = 1.0;
// What is commanded beyond the peak torque of a drive, three times rated, is not had.
constexpr double kPeakForce = 3.0;
// In Stribeck velocities: where the slope has faded.
constexpr double kFast = 10.0;
// At rest an axis may move by this share of what friction winds its screw up by, as every one may.
constexpr double kRestShare = 0.2;
constexpr double kLeastFriction = 0.1;

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

Friction Times(Friction f, double factor) {
  for (double* v : {&f.Fs_plus_N, &f.Fs_minus_N, &f.Fc_plus_N, &f.Fc_minus_N, &f.sigma0_N_m, &f.sigma1_Ns_m})
    *v *= factor;
  return f;
}

}  // namespace

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

  const auto steps =
      static_cast<int>(std::ceil(std::max(kStepsPerPeriod, kStepsPerSwing * ModeFrequency_Hz(m) * period_s)));
  const double dt_s = period_s / steps;
  const double follows = m.lag_s > 0.0 ? 1.0 - std::exp(-dt_s / m.lag_s) : 1.0;
  const double most_N = kPeakForce * a.rated_force_N;
  Delay delay(m, period_s, steps, fed_N);
  // It begins in steady sliding, behind by as much as the bristles bend.
  table.SlideAt(speed_m_s);
  motor.SlideAt(speed_m_s);
  double p2 = -Bends_m(friction), v2 = speed_m_s, p1 = p2 + lead_m, v1 = speed_m_s, force_N = fed_N;
  Swing creeping, resting;
  const auto cycles = static_cast<int>((kCreeps_s + kRests_s) / period_s);
  for (int i = 0; i < cycles; ++i) {
    const double time_s = i * period_s;
    const double wanted_m = speed_m_s * std::min(time_s, kCreeps_s);
    y << p1 - wanted_m - lead_m, p2 - wanted_m;
    const double command_N = (controller.c * state + controller.d * y)(0, 0) * unit_N + fed_N;
    state = (controller.a * state + controller.b * y).eval();
    delay.Send(std::clamp(command_N, -most_N, most_N));
    for (int j = 0; j < steps; ++j) {
      force_N += (delay.At(j) - force_N) * follows;
      const double screw_N = m.stiffness_N_m * (p1 - p2) + m.damping_Ns_m * (v1 - v2);
      v1 += dt_s * (force_N - screw_N - motor.Step_N(v1, dt_s)) / m.motor_mass_kg;
      v2 += dt_s * (screw_N - table.Step_N(v2, dt_s) - m.viscous_Ns_m * v2) / m.table_mass_kg;
      p1 += dt_s * v1;
      p2 += dt_s * v2;
    }
    if (time_s < kCreeps_s && time_s >= kCreeps_s - kLooksFor_s) creeping.Put(p2 - wanted_m);
    if (time_s >= kCreeps_s + kRests_s - kLooksFor_s) resting.Put(p2 - wanted_m);
  }
  return {speed_m_s, creeping.size_m(), resting.size_m()};
}

StickSlip StickSlipOf(const LoopAxis& axis, const TwoInertiaLoop& loop, double period_s) {
  const double bends_m = Bends_m(axis.friction);
  std::vector<double> speeds = SlopeSpeeds_m_s(axis);
  speeds.push_back(kFast * axis.friction.vs_m_s);
  StickSlip out;
  out.most_rest_m = kRestShare * Coulomb_N(axis.friction) / axis.axis.stiffness_N_m;
  for (const double off : {-axis.friction_std, 0.0, axis.friction_std}) {
    for (const double speed_m_s : speeds) {
      const Creep c = CreepAt(axis, loop, period_s, speed_m_s, std::max(1.0 + off, kLeastFriction));
      // What is not a number has run away.
      const auto size_m = [](double swing_m) {
        return swing_m >= 0.0 ? swing_m : std::numeric_limits<double>::infinity();
      };
      out.rest_m = std::max(out.rest_m, size_m(c.rest_m));
      if (size_m(c.swing_m) > out.swing_m) {
        out.swing_m = size_m(c.swing_m);
        out.at_m_s = speed_m_s;
      }
      if (size_m(c.swing_m) <= bends_m) continue;
      out.slowest_m_s = out.Sticks() ? std::min(out.slowest_m_s, speed_m_s) : speed_m_s;
      out.fastest_m_s = std::max(out.fastest_m_s, speed_m_s);
    }
  }
  return out;
}

}  // namespace contour
