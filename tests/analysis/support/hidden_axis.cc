#include "tests/analysis/support/hidden_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/analysis/support/hidden_motion.h"

namespace contour::diagnosis::test {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr int kSteps = 40;

// Friction of one element, in the generalised coordinate, moved over a step at a given mean speed.
struct Bristle {
  double z = 0.0;
  double Move(double s0, double s1, double g, double v, double h) {
    const double a = s0 * std::fabs(v) / g;
    const double e = std::exp(-a * h);
    const double mean = a * h < 1e-6 ? 1.0 - 0.5 * a * h : (1.0 - e) / (a * h);
    const double z1 = z * e + v * h * mean;
    const double force = s0 * 0.5 * (z + z1) + s1 * (z1 - z) / h;
    z = z1;
    return force;
  }
};

// Parallel elastic elements, each slipping at its own share of the level.
struct MaxwellSlip {
  std::vector<double> force = std::vector<double>(12, 0.0);
  double Move(double s0, double g, double v, double h) {
    double total = 0.0, weight = 0.0;
    const auto n = force.size();
    for (std::size_t i = 0; i < n; ++i) weight += 1.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double share = g / weight;
      // Break-away travel spread over a factor of 40 about g / s0.
      const double travel =
          g / s0 * std::pow(40.0, (static_cast<double>(i) + 0.5) / static_cast<double>(n) - 0.4);
      force[i] = std::clamp(force[i] + share / travel * v * h, -share, share);
      total += force[i];
    }
    return total;
  }
};

struct Truth {
  double Jm, Jl, K, D, Fc_plus, Fc_minus, Fs_ratio, vs, s0, s1, s2, offset, delay, lag, kt, R, rated;
};

}  // namespace

HiddenAxis HiddenAxisFor(double duration_s) {
  HiddenOptions o;
  o.duration_s = duration_s;
  return MakeHiddenAxis(o);
}

HiddenAxis MakeHiddenAxis(const HiddenOptions& o) {
  std::mt19937_64 random(o.seed * 7919 + 17);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  HiddenAxis out;
  StatedAxis& s = out.stated;
  AxisLog& log = out.log;
  const double Ts = 1e-3;
  // The machine: rotary in Nm and rad; a linear one is the same seen at the carriage (R = 1).
  const double R = 0.005 / kTwoPi;
  s.lead_m = 0.005;
  s.two_inertia = o.two_inertia;
  s.friction_on_load = o.friction_on_load;
  const double u_scale = o.linear ? 1.0 / R : 1.0;  // N per Nm
  const double q_scale = o.linear ? R : 1.0;        // m per rad
  s.linear = log.linear = o.linear;
  s.table_per_q = o.linear ? 1.0 : R;
  s.rated = 0.64 * u_scale;
  const double k_scale = u_scale / q_scale;
  s.motor_inertia = (o.two_inertia ? 6e-5 : 9e-5) * k_scale;
  s.load_inertia = o.two_inertia ? 4e-5 * k_scale : 0.0;
  const double f_ar = 90.0 + 60.0 * uniform(random);
  s.stiffness = o.two_inertia ? s.load_inertia * std::pow(kTwoPi * f_ar, 2) : 0.0;
  s.damping = o.two_inertia ? 0.06 * std::sqrt(s.stiffness * s.load_inertia) : 0.0;
  StatedFriction& f = s.friction;
  f.Fc_plus = f.Fc_minus = 0.05 * (0.8 + 0.4 * uniform(random)) * u_scale;
  f.Fs_plus = f.Fs_minus = 1.3 * f.Fc_plus;
  f.vs = 2.0 * q_scale;
  f.exponent = uniform(random) < 0.5 ? 1.0 : 2.0;
  f.s0 = f.Fc_plus / (0.01 * q_scale);
  f.s1 = 0.3 * std::sqrt(f.s0 * 9e-5 * k_scale);
  f.s2 = 1.5e-4 * k_scale;
  s.delay_s = 1e-3;
  s.lag_s = 0.2e-3;
  const double step_rad = o.encoder_step_rad > 0.0 ? o.encoder_step_rad : kTwoPi / 131072.0;
  s.position_step = step_rad * q_scale;
  s.command_step = 1e-3 * s.rated;
  s.stroke_min_m = -0.1;
  s.stroke_max_m = 0.1;
  s.sigma = {{"inertia", .05},  {"load_inertia", .05},
             {"stiffness", .1}, {"damping", .3},
             {"Fc", .1},        {"Fs", .1},
             {"vs", .2},        {"s0", .2},
             {"s1", .3},        {"s2", .1},
             {"delay", .01},    {"lag", .05}};
  const auto off = [&](const char* name) {
    return 1.0 + o.parameter_spread * s.sigma[name] * std::clamp(normal(random), -2.0, 2.0);
  };
  Truth t{};
  t.R = s.table_per_q;
  t.rated = s.rated;
  t.Jm = s.motor_inertia * off("inertia");
  t.Jl = s.load_inertia * off("load_inertia");
  t.K = s.stiffness * off("stiffness");
  t.D = s.damping * off("damping");
  t.Fc_plus = t.Fc_minus = f.Fc_plus * off("Fc");
  // The stated uncertainty is that of the level, not of its ratio to the other.
  t.Fs_ratio = std::max(1.02, f.Fs_plus * off("Fs") / t.Fc_plus);
  t.vs = f.vs * off("vs");
  t.s0 = f.s0 * off("s0");
  t.s1 = f.s1 * off("s1");
  t.s2 = f.s2 * off("s2");
  t.delay = s.delay_s * (o.delay_lag_factor != 1.0 ? o.delay_lag_factor : off("delay"));
  t.lag = s.lag_s * (o.delay_lag_factor != 1.0 ? o.delay_lag_factor : off("lag"));
  t.kt = 1.0;
  bool two = o.two_inertia, on_load = o.friction_on_load && o.two_inertia;
  double sum_soft = 0.0, soft_ratio = 0.1, gap = 0.0;
  const double total = t.Jm + t.Jl;
  for (const HiddenEffect& e : o.effects) {
    if (e.kind == "asymmetric_coulomb") {
      t.Fc_plus *= 1.0 + 0.5 * e.size;
      t.Fc_minus *= 1.0 - 0.5 * e.size;
    } else if (e.kind == "stribeck") {
      t.Fs_ratio *= 1.0 + e.size;
    } else if (e.kind == "torque_constant") {
      t.kt = 1.0 + e.size;
    } else if (e.kind == "input_delay") {
      t.delay += e.size * 1e-3;
    } else if (e.kind == "current_lag") {
      t.lag += e.size * 1e-3;
    } else if (e.kind == "presliding_hysteresis") {
      sum_soft = e.size;
    } else if (e.kind == "backlash") {
      gap = e.size * 1e-4 * q_scale / R * R / q_scale;  // metres: size 1 is 100 um at the table
      gap = e.size * 1e-4 / t.R;
      if (!two) {
        two = true;
        t.Jl = 0.4 * total;
        t.Jm = 0.6 * total;
        t.K = t.Jl * std::pow(kTwoPi * 400.0, 2);
        t.D = 0.1 * std::sqrt(t.K * t.Jl);
      }
    } else if (e.kind == "compliance") {
      if (two) {
        t.K *= 1.0 - std::min(0.9, e.size);
      } else {
        two = true;
        t.Jl = 0.4 * total;
        t.Jm = 0.6 * total;
        t.K = t.Jl * std::pow(kTwoPi * 60.0 / std::max(e.size, 0.05), 2);  // softer with size
        t.D = 0.06 * std::sqrt(t.K * t.Jl);
      }
    }
  }
  const auto rows = static_cast<std::size_t>(o.duration_s / Ts);
  const Motion motion = MakeMotion(rows, Ts, s.stroke_max_m, o.seed);
  log.source = "hidden axis";
  log.period_s = Ts;
  log.rows = rows;
  log.present.assign(rows, 1);
  log.command.resize(rows);
  log.position.resize(rows);
  log.reference_position.resize(rows);
  if (o.scale) log.table_position_m.resize(rows);
  if (o.temperature) log.temperature_degC.resize(rows);
  if (o.axis2) log.axis2_position_m.resize(rows);
  const double h = Ts / kSteps;
  double th = motion.table_m[0] / t.R, w = 0.0, thl = th, wl = 0.0, current = 0.0, a_m = 0.0, a_l = 0.0;
  Bristle main, soft;
  MaxwellSlip slip;
  std::vector<double> queue(rows + 64, 0.0);
  double last_y = th, speed = 0.0;
  const double wc = kTwoPi * 12.0;
  for (std::size_t k = 0; k < rows; ++k) {
    const double time = static_cast<double>(k) * Ts;
    const double temperature = 22.0 + 9.0 * std::pow(std::sin(std::numbers::pi * time / o.duration_s), 2) +
                               1.5 * std::sin(kTwoPi * time / 23.0);
    const double noise = o.torque_noise_rel * s.rated * (time > 0.5 * o.duration_s ? o.noise_change : 1.0);
    // Readings.
    double seen = th + o.timing_error_s * w, table_m = (two ? thl : th) * t.R;
    for (const HiddenEffect& e : o.effects) {
      const double angle = th * t.R / R;
      if (e.kind == "encoder_eccentricity" || e.kind == "encoder_subdivision")
        seen += e.size * 1e-3 * std::sin(e.order * angle + e.phase) * q_scale;
      if (e.kind == "sample_jitter") seen += e.size * 1e-6 * normal(random) * w;
      if (e.kind == "pitch_error") table_m += e.size * 1e-6 * std::sin(kTwoPi * table_m / 0.17 + e.phase);
    }
    const double read = std::floor(seen / s.position_step + 0.5 + 0.3 * normal(random)) * s.position_step;
    log.position[k] = read;
    if (o.scale) log.table_position_m[k] = std::round((table_m + 0.3e-6 * normal(random)) / 1e-7) * 1e-7;
    if (o.temperature) log.temperature_degC[k] = temperature;
    if (o.axis2) log.axis2_position_m[k] = std::round(motion.axis2_m[k] / 1e-8) * 1e-8;
    // Control: PD with feed-forward, in the unit of the axis.
    const double ref = motion.table_m[k] / t.R, ref_w = motion.velocity_m_s[k] / t.R;
    log.reference_position[k] = ref;
    speed += 0.4 * ((read - last_y) / Ts - speed);
    last_y = read;
    const double J = s.motor_inertia + s.load_inertia;
    double u = J * (motion.acceleration_m_s2[k] / t.R + wc * wc * (ref - read) + 1.6 * wc * (ref_w - speed)) +
               f.Fc_plus * std::tanh(ref_w / (0.2 * q_scale)) + motion.dither_rel[k] * s.rated;
    u = std::clamp(u, -2.0 * s.rated, 2.0 * s.rated);
    u = std::round(u / s.command_step) * s.command_step;
    log.command[k] = u;
    queue[k] = u;
    const double disturbance = noise * normal(random);
    for (int j = 0; j < kSteps; ++j) {
      const double now = time + h * (j + 0.5);
      const double at = (now - t.delay) / Ts;
      const double command = at < 0.0 ? queue[0] : queue[static_cast<std::size_t>(at)];
      const double kept = std::exp(-h / std::max(t.lag, 1e-9));
      const double before = current;
      current = command + (current - command) * kept;
      double torque = t.kt * 0.5 * (before + current);
      const double wm = w + 0.5 * h * a_m, wlm = two ? wl + 0.5 * h * a_l : wm;
      const double vf = two && on_load ? wlm : wm;
      const double q_m = th + 0.5 * h * wm, q_l = two ? thl + 0.5 * h * wlm : q_m;
      const double angle = q_m * t.R / R, x = q_l * t.R;
      double level = 1.0, viscous = 1.0, at_motor = disturbance, at_load = 0.0, payload = 0.0;
      for (const HiddenEffect& e : o.effects) {
        const double wave = std::sin(e.order * angle + e.phase);
        if (e.kind == "constant_torque") at_motor += e.size * f.Fc_plus;
        if (e.kind == "position_friction") level += e.size * std::sin(kTwoPi * x / 0.17 + e.phase);
        if (e.kind == "cable_spring") {
          const double y = x / 0.1;
          at_load -= e.size * f.Fc_plus * y * (0.7 + 0.3 * y * y);
        }
        if (e.kind == "friction_ripple" || e.kind == "ball_ripple") level += e.size * wave;
        if (e.kind == "cogging") at_motor += e.size * f.Fc_plus * wave;
        if (e.kind == "viscous_nonlinear") {
          const double y = std::fabs(vf) / (300.0 * q_scale);
          at_load -= std::copysign(e.size * f.Fc_plus * std::pow(y, e.extra > 0.0 ? e.extra : 2.0), vf);
        }
        if (e.kind == "temperature_viscosity") viscous += e.size * (temperature - 26.0);
        if (e.kind == "friction_drift" || e.kind == "viscous_drift") {
          const double done = e.extra > 0.0 ? 1.0 - std::exp(-now / e.extra) : now / o.duration_s;
          (e.kind == "viscous_drift" ? viscous : level) += e.size * done;
        }
        if (e.kind == "torque_saturation") torque *= 1.0 - e.size * std::pow(torque / s.rated, 2);
        if (e.kind == "torque_limit") torque = std::clamp(torque, -e.size * s.rated, e.size * s.rated);
        if (e.kind == "payload_step" && now > e.extra * o.duration_s) payload = e.size * total;
        if (e.kind == "cross_coupling") at_load += e.size * f.Fc_plus * motion.axis2_m_s2[k] / 3.0;
        if (e.kind == "load_friction") {
          const double inertia = std::fabs(total * a_m);
          level += e.size * inertia / f.Fc_plus;
        }
        if (e.kind == "periodic_force")
          at_load += e.size * f.Fc_plus * std::sin(kTwoPi * e.order * now + e.phase);
        if (e.kind == "torque_ripple") torque *= 1.0 + e.size * wave;
        if (e.kind == "push" && now > 0.4 * o.duration_s && now < 0.55 * o.duration_s)
          at_load += e.size * f.Fc_plus;
        if (e.kind == "friction_step" && now > 0.55 * o.duration_s) level += e.size;
      }
      level = std::max(level, 0.05);
      double y = std::fabs(vf) / t.vs;
      if (f.exponent > 1.5) y *= y;
      const double Fc = vf < 0.0 ? t.Fc_minus : t.Fc_plus;
      const double g = level * Fc * (1.0 + (t.Fs_ratio - 1.0) * std::exp(-y));
      double friction = t.s2 * viscous * vf;
      if (o.maxwell_slip) {
        friction += slip.Move(t.s0, g, vf, h);
      } else {
        const double rest = 1.0 - sum_soft;
        friction += main.Move(t.s0 * rest, t.s1, g * rest, vf, h);
        if (sum_soft > 0.0) friction += soft.Move(t.s0 * sum_soft * soft_ratio, 0.0, g * sum_soft, vf, h);
      }
      if (two) {
        const double wind = (th - thl) + 0.5 * h * (wm - wlm);
        double spring = 0.0;
        if (std::fabs(wind) >= 0.5 * gap)
          spring = t.K * (wind - std::copysign(0.5 * gap, wind)) + t.D * (wm - wlm);
        a_m = (torque + at_motor - spring - (on_load ? 0.0 : friction)) / t.Jm;
        a_l = (spring + at_load - (on_load ? friction : 0.0)) / (t.Jl + payload);
        thl += h * (wl + 0.5 * h * a_l);
        wl += h * a_l;
      } else {
        a_m = (torque + at_motor + at_load - friction) / (t.Jm + payload);
      }
      th += h * (w + 0.5 * h * a_m);
      w += h * a_m;
    }
  }
  return out;
}

}  // namespace contour::diagnosis::test
