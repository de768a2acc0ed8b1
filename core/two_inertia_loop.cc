#include "core/two_inertia_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/stationary_riccati.h"

// Inside, time is counted in periods, mass in that of the whole axis and lengths in metres, so that the
// numbers are of the size of one whatever the machine.
namespace contour {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
// A drive without a lag has one of a thousandth of the period, so that the force of the motor is a state.
constexpr double kLeastLag = 1e-3;
// Above this share of the sampling frequency a torque filter cannot have its frequency.
constexpr double kHighestFilter = 0.45;
constexpr Eigen::Index kMotion = kLoopMotion;
constexpr Eigen::Index kV1 = 1, kP2 = 2, kV2 = 3;

void RequirePositive(const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw std::invalid_argument(std::string(name) + ": expected a positive number");
}
void RequireNotNegative(const char* name, double value) {
  if (!(value >= 0.0) || !std::isfinite(value))
    throw std::invalid_argument(std::string(name) + ": expected no negative number");
}

void Check(const TwoInertiaAxis& a, double period_s) {
  RequirePositive("motor_mass_kg", a.motor_mass_kg);
  RequirePositive("table_mass_kg", a.table_mass_kg);
  RequirePositive("stiffness_N_m", a.stiffness_N_m);
  RequireNotNegative("damping_Ns_m", a.damping_Ns_m);
  RequireNotNegative("viscous_Ns_m", a.viscous_Ns_m);
  RequireNotNegative("lag_s", a.lag_s);
  RequirePositive("period_s", period_s);
  if (a.delay_cycles < 0) throw std::invalid_argument("delay_cycles: expected no negative number");
  if (!std::isfinite(a.dead_time_s)) throw std::invalid_argument("dead_time_s: expected a finite number");
}

void Check(const LoopTuning& t, bool scale) {
  RequirePositive("regulator_Hz", t.regulator_Hz);
  RequireNotNegative("windup_weight", t.windup_weight);
  RequireNotNegative("velocity_weight", t.velocity_weight);
  RequirePositive("disturbance_Hz", t.disturbance_Hz);
  RequirePositive("motor_force_Hz", t.motor_force_Hz);
  RequirePositive("table_force_Hz", t.table_force_Hz);
  RequirePositive("notch_ratio", t.notch_ratio);
  RequirePositive("notch_pole_damping", t.notch_pole_damping);
  RequirePositive("notch_zero_damping", t.notch_zero_damping);
  if (!scale) return;
  RequirePositive("scale_noise_ratio", t.scale_noise_ratio);
  RequirePositive("bias_Hz", t.bias_Hz);
}

/// The axis over one period, in the numbers of this file.
struct Step {
  SmallMatrix motion;  ///< 5 x 5
  SmallMatrix input;   ///< 5 x 2: of the command that still acts, and of the one that takes over
  SmallMatrix force;   ///< 5 x 2: of a force on the motor, and of one on the table
  std::size_t queued = 0;
  double late_share = 0.0;
};

/// Exact motion over `share` of a period: columns are the motion, then command, force on motor and table.
SmallMatrix Over(const TwoInertiaAxis& a, double period_s, double share) {
  const double mass_kg = a.motor_mass_kg + a.table_mass_kg;
  const double m1 = a.motor_mass_kg / mass_kg;
  const double m2 = a.table_mass_kg / mass_kg;
  const double k = a.stiffness_N_m * period_s * period_s / mass_kg;
  const double c = a.damping_Ns_m * period_s / mass_kg;
  const double s2 = a.viscous_Ns_m * period_s / mass_kg;
  const double lag = std::max(a.lag_s / period_s, kLeastLag);
  SmallMatrix rate = SmallMatrix::Zero(8, 8);
  rate(0, 1) = 1.0;
  rate.row(kV1) << -k / m1, -c / m1, k / m1, c / m1, 1.0 / m1, 0.0, 1.0 / m1, 0.0;
  rate(kP2, 3) = 1.0;
  rate.row(kV2) << k / m2, c / m2, -k / m2, -(c + s2) / m2, 0.0, 0.0, 0.0, 1.0 / m2;
  rate(4, 4) = -1.0 / lag;
  rate(4, 5) = 1.0 / lag;
  const SmallMatrix scaled = rate * share;
  return scaled.exp();
}

Step StepOf(const TwoInertiaAxis& a, double period_s) {
  const double delay = std::max(0.0, a.delay_cycles + a.dead_time_s / period_s);
  const double whole = std::floor(delay + 1e-9);
  const double rest = std::max(0.0, delay - whole);
  Step step;
  const SmallMatrix all = Over(a, period_s, 1.0);
  step.motion = all.block(0, 0, kMotion, kMotion);
  step.force = all.block(0, kMotion + 1, kMotion, 2);
  step.input = SmallMatrix::Zero(kMotion, 2);
  step.queued = static_cast<std::size_t>(whole);
  if (rest < 1e-9) {
    step.input.col(0) = all.block(0, kMotion, kMotion, 1);
  } else {
    const SmallMatrix first = Over(a, period_s, rest);
    const SmallMatrix second = Over(a, period_s, 1.0 - rest);
    step.input.col(0) = second.block(0, 0, kMotion, kMotion) * first.block(0, kMotion, kMotion, 1);
    step.input.col(1) = second.block(0, kMotion, kMotion, 1);
    step.late_share = rest;
    ++step.queued;
  }
  if (step.queued > kLoopQueue)
    throw std::invalid_argument("dead_time_s: expected at most " + std::to_string(kLoopQueue) +
                                " periods of delay");
  return step;
}

/// Stationary Kalman gain, states x 2 (or x 1), rows as in TwoInertiaLoop but for b where there is no scale.
SmallMatrix ObserverGain(const TwoInertiaAxis& a, const Step& step, const LoopTuning& t, double period_s,
                         bool scale) {
  const double mass_kg = a.motor_mass_kg + a.table_mass_kg;
  const auto rate = [&](double frequency_Hz) { return kTwoPi * frequency_Hz * period_s; };
  const Eigen::Index n = kMotion + (scale ? 2 : 1);
  const Eigen::Index d = n - 1;
  SmallMatrix transition = SmallMatrix::Identity(n, n);
  transition.topLeftCorner(kMotion, kMotion) = step.motion;
  transition.block(0, d, kMotion, 1) = -step.force.col(1);
  // With white noise of one unit in the encoder: where two frequencies meet, both are believed alike.
  SmallMatrix noise = SmallMatrix::Zero(n, n);
  const double motor = a.motor_mass_kg / mass_kg * std::pow(rate(t.motor_force_Hz), 2);
  const double table = a.table_mass_kg / mass_kg * std::pow(rate(t.table_force_Hz), 2);
  noise.topLeftCorner(kMotion, kMotion) = motor * motor * step.force.col(0) * step.force.col(0).transpose() +
                                          table * table * step.force.col(1) * step.force.col(1).transpose();
  noise(d, d) = std::pow(rate(t.disturbance_Hz), 6);
  SmallMatrix seen = SmallMatrix::Zero(scale ? 2 : 1, n);
  SmallMatrix error = SmallMatrix::Identity(seen.rows(), seen.rows());
  seen(0, 0) = 1.0;
  if (scale) {
    seen(0, kMotion) = 1.0;
    seen(1, kP2) = 1.0;
    error(1, 1) = t.scale_noise_ratio * t.scale_noise_ratio;
    noise(kMotion, kMotion) = std::pow(rate(t.bias_Hz), 2);
  }
  const auto prior = SolveRiccati(transition.transpose(), seen.transpose(), noise, error);
  if (!prior) throw std::invalid_argument("observer: this tuning gives no stationary gain");
  const SmallMatrix innovation = seen * *prior * seen.transpose() + error;
  return innovation.ldlt().solve(seen * *prior).transpose();
}

/// Gain of the linear-quadratic regulator over motion and queue, a row.
SmallMatrix RegulatorGain(const Step& step, const LoopTuning& t, double period_s) {
  const auto queued = static_cast<Eigen::Index>(step.queued);
  const Eigen::Index n = kMotion + queued;
  SmallMatrix transition = SmallMatrix::Zero(n, n);
  SmallMatrix command = SmallMatrix::Zero(n, 1);
  transition.topLeftCorner(kMotion, kMotion) = step.motion;
  for (Eigen::Index i = 0; i < 2; ++i) {
    if (i < queued)
      transition.block(0, kMotion + i, kMotion, 1) = step.input.col(i);
    else if (i == queued)
      command.topRows(kMotion) = step.input.col(i);
  }
  for (Eigen::Index i = 0; i + 1 < queued; ++i) transition(kMotion + i, kMotion + i + 1) = 1.0;
  if (queued > 0) command(n - 1, 0) = 1.0;
  const double rate = kTwoPi * t.regulator_Hz * period_s;
  SmallMatrix cost = SmallMatrix::Zero(n, n);
  const double windup = std::pow(t.windup_weight / rate, 2);
  cost(kP2, kP2) = 1.0;
  cost(kV1, kV1) = windup;
  cost(kV1, kV2) = cost(kV2, kV1) = -windup;
  cost(kV2, kV2) = windup + std::pow(t.velocity_weight / rate, 2);
  const SmallMatrix effort = SmallMatrix::Constant(1, 1, std::pow(rate, -4));
  const auto value = SolveRiccati(transition, command, cost, effort);
  if (!value) throw std::invalid_argument("regulator: this tuning gives no stationary gain");
  const SmallMatrix denominator = effort + command.transpose() * *value * command;
  return command.transpose() * *value * transition / denominator(0, 0);
}

/// (s^2 + 2 zero w s + w^2) / (s^2 + 2 pole w s + w^2), bilinear with its frequency kept.
Biquad FilterOf(double frequency_Hz, double pole_damping, double zero_damping, double period_s) {
  const double share = std::min(frequency_Hz * period_s, kHighestFilter);
  const double g = std::tan(0.5 * kTwoPi * share);
  const double norm = 1.0 + 2.0 * pole_damping * g + g * g;
  Biquad q;
  q.b0 = (1.0 + 2.0 * zero_damping * g + g * g) / norm;
  q.b1 = q.a1 = 2.0 * (g * g - 1.0) / norm;
  q.b2 = (1.0 - 2.0 * zero_damping * g + g * g) / norm;
  q.a2 = (1.0 - 2.0 * pole_damping * g + g * g) / norm;
  return q;
}

/// SI unit of each of p1, v1, p2, v2, u in the numbers of this file.
LoopMotion Units(const TwoInertiaAxis& a, double period_s) {
  const double velocity = 1.0 / period_s;
  const double force = (a.motor_mass_kg + a.table_mass_kg) / (period_s * period_s);
  return {1.0, velocity, 1.0, velocity, force};
}

void PutMotion(const TwoInertiaAxis& a, const Step& step, double period_s, TwoInertiaLoop& loop) {
  const LoopMotion unit = Units(a, period_s);
  const double force = unit[4];
  for (std::size_t i = 0; i < kLoopMotion; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < kLoopMotion; ++j)
      loop.motion_from_motion[i][j] = step.motion(row, static_cast<Eigen::Index>(j)) * unit[i] / unit[j];
    for (std::size_t j = 0; j < 2; ++j)
      loop.motion_from_input[j][i] = step.input(row, static_cast<Eigen::Index>(j)) * unit[i] / force;
    loop.motion_from_disturbance[i] = -step.force(row, 1) * unit[i] / force;
  }
  loop.queued = step.queued;
  loop.late_share = step.late_share;
}

}  // namespace

double ModeFrequency_Hz(const TwoInertiaAxis& a) noexcept {
  return std::sqrt(a.stiffness_N_m * (1.0 / a.motor_mass_kg + 1.0 / a.table_mass_kg)) / kTwoPi;
}

// The observer knows the commands, so what it finds does not depend on them.
std::array<double, kLoopTaps> ResponseOfObserver(const TwoInertiaLoop& loop,
                                                 const LoopMotion& motion_per_N) noexcept {
  std::array<double, kLoopTaps> response{};
  LoopMotion error{};  // true motion minus the observer's
  double bias = 0.0, found = 0.0;
  for (std::size_t j = 0; j < kLoopTaps; ++j) {
    const std::array<double, 2> innovation{error[0] - bias, error[2]};
    const auto share = [&](std::size_t i) {
      return loop.gain[i][0] * innovation[0] + loop.gain[i][1] * innovation[1];
    };
    for (std::size_t i = 0; i < kLoopMotion; ++i) error[i] -= share(i);
    bias += share(kObserverBias);
    found += share(kObserverDisturbance);
    response[j] = found;
    LoopMotion next{};
    for (std::size_t i = 0; i < kLoopMotion; ++i) {
      next[i] = (j == 0 ? motion_per_N[i] : 0.0) - loop.motion_from_disturbance[i] * found;
      for (std::size_t k = 0; k < kLoopMotion; ++k) next[i] += loop.motion_from_motion[i][k] * error[k];
    }
    error = next;
  }
  return response;
}

TwoInertiaLoop LoopMotionOf(const TwoInertiaAxis& axis, double period_s) {
  Check(axis, period_s);
  TwoInertiaLoop loop;
  PutMotion(axis, StepOf(axis, period_s), period_s, loop);
  return loop;
}

TwoInertiaLoop DesignLoop(const TwoInertiaAxis& axis, const LoopTuning& tuning, double period_s, bool scale) {
  Check(axis, period_s);
  Check(tuning, scale);
  const Step step = StepOf(axis, period_s);
  TwoInertiaLoop loop;
  PutMotion(axis, step, period_s, loop);
  loop.scale = scale;
  const LoopMotion unit = Units(axis, period_s);
  const double force = unit[4];

  const SmallMatrix gain = ObserverGain(axis, step, tuning, period_s, scale);
  for (Eigen::Index j = 0; j < gain.cols(); ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (std::size_t i = 0; i < kLoopMotion; ++i)
      loop.gain[i][column] = gain(static_cast<Eigen::Index>(i), j) * unit[i];
    if (scale) loop.gain[kObserverBias][column] = gain(kMotion, j);
    loop.gain[kObserverDisturbance][column] = gain(gain.rows() - 1, j) * force;
  }

  const SmallMatrix regulator = RegulatorGain(step, tuning, period_s);
  loop.steady_motion = {1.0 / axis.stiffness_N_m, 0.0, 0.0, 0.0, 1.0};
  loop.disturbance_to_command = 1.0;
  for (std::size_t i = 0; i < kLoopMotion; ++i) {
    loop.regulator_motion[i] = regulator(0, static_cast<Eigen::Index>(i)) * force / unit[i];
    loop.disturbance_to_command += loop.regulator_motion[i] * loop.steady_motion[i];
  }
  for (std::size_t i = 0; i < loop.queued; ++i) {
    loop.regulator_queue[i] = regulator(0, kMotion + static_cast<Eigen::Index>(i));
    loop.disturbance_to_command += loop.regulator_queue[i];
  }

  loop.filter = FilterOf(tuning.notch_ratio * ModeFrequency_Hz(axis), tuning.notch_pole_damping,
                         tuning.notch_zero_damping, period_s);
  loop.disturbance_response = ResponseOfObserver(loop, loop.motion_from_disturbance);
  return loop;
}

}  // namespace contour
