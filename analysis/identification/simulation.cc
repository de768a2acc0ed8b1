#include "analysis/identification/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "analysis/axis_model/linear_axis.h"
#include "analysis/identification/own_force.h"
#include "analysis/prediction_error/steady_gain.h"
#include "estimator/exponential.h"

namespace contour::identify {
namespace {

/// Prediction errors are not used for so long after a start: the bristle's state is not known there.
constexpr double kSettle_s = 0.05;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
/// Beyond this exp(-x) is nothing.
constexpr double kGone = 40.0;
constexpr double kShortestLag_s = 5e-6;
constexpr double kNoStep_s = 1e-9;
constexpr int kLongestGap = 5;
constexpr double kMoving_m_s = 50e-6;
constexpr double kBristleCorrection = 0.05;
constexpr double kFollow_Hz = 60.0;
/// Of a value that is rounded, and noisy by about as much: standard deviation over its step.
constexpr double kRoundedNoise = 0.4;

struct Discrete {
  Eigen::Matrix4d a;
  Eigen::Vector4d table;    ///< per N at the mass that rubs
  Eigen::Vector4d delayed;  ///< per N behind the lag at the beginning
  Eigen::Vector4d command;  ///< per N commanded
  Eigen::Vector4d motor;    ///< per N at the motor, at once
  double lag_left = 0.0;
};

/// Everything linear over a step, with the current loop df/dt = (command - f) / lag in it: exact.
Discrete Over(const TableAxis& p, double viscous_Ns_m, double step_s) {
  const double on_motor = p.two_inertia && p.friction_on_load ? p.motor_friction_share : 0.0;
  diagnosis::LinearAxis linear = diagnosis::MakeLinearAxis(p, (1.0 - on_motor) * viscous_Ns_m);
  linear.dynamics(1, 1) -= on_motor * viscous_Ns_m / p.motor_inertia;
  const double lag = std::max(p.lag_s, kShortestLag_s);
  Eigen::Matrix<double, 8, 8> all = Eigen::Matrix<double, 8, 8>::Zero();
  all.topLeftCorner<4, 4>() = linear.dynamics;
  all.block<4, 1>(0, 4) = p.two_inertia ? linear.load : linear.motor;
  all.block<4, 1>(0, 5) = linear.motor;
  all(5, 5) = -1.0 / lag;
  all(5, 6) = 1.0 / lag;
  all.block<4, 1>(0, 7) = linear.motor;
  const Eigen::Matrix<double, 8, 8> e = (all * step_s).exp();
  return {e.topLeftCorner<4, 4>(), e.block<4, 1>(0, 4), e.block<4, 1>(0, 5),
          e.block<4, 1>(0, 6),     e.block<4, 1>(0, 7), e(5, 5)};
}

double Harmonics(const std::array<double, 2 * LevelVariation::kHarmonics>& c, double cos1, double sin1) {
  double cos_n = cos1;
  double sin_n = sin1;
  double sum = 0.0;
  for (std::size_t n = 0; n < LevelVariation::kHarmonics; ++n) {
    sum += c[2 * n] * cos_n + c[2 * n + 1] * sin_n;
    const double next = cos_n * cos1 - sin_n * sin1;
    sin_n = sin_n * cos1 + cos_n * sin1;
    cos_n = next;
  }
  return sum;
}

double Place(const LevelVariation& v, double x_m) {
  if (!(v.high_m > v.low_m)) return 0.0;
  const double x = std::clamp((2.0 * x_m - v.low_m - v.high_m) / (v.high_m - v.low_m), -1.0, 1.0);
  return v.place[0] * x + v.place[1] * 0.5 * (3.0 * x * x - 1.0) + v.place[2] * 0.5 * (5.0 * x * x - 3.0) * x;
}

}  // namespace

namespace {

/// `ratio`: movement in a period by a disturbance, of the noise of a reading. `on_motor` is the share of that
/// disturbance's variance that acts there.
FollowGain SteadyFollowGain(const TableAxis& axis, double period_s, double ratio, double on_table,
                            double on_motor) {
  const Discrete d = Over(axis, 0.0, period_s);
  const double noise_m = period_s * period_s / axis.mass_kg() / ratio;
  const Eigen::Vector4d motor = d.command + d.delayed;
  const Eigen::Matrix4d q = on_table * d.table * d.table.transpose() + on_motor * motor * motor.transpose();
  const int n = axis.two_inertia ? 4 : 2;
  FollowGain gain = FollowGain::Zero();
  gain.head(n) = diagnosis::SteadyGain(d.a.topLeftCorner(n, n), q.topLeftCorner(n, n), noise_m * noise_m,
                                       1e6 * q.topLeftCorner(n, n));
  return gain;
}

}  // namespace

FollowGain MakeFollowGain(const TableAxis& axis, double period_s, double bandwidth_Hz) {
  // A disturbance of 1 N for a period; the noise then sets the bandwidth: omega^2 T^2 = ratio of the two.
  const double omega_t = std::min(1.0, 2.0 * std::numbers::pi * bandwidth_Hz * period_s);
  return SteadyFollowGain(axis, period_s, omega_t * omega_t, 1.0, 0.1);
}

double ReportStep_N(const Measured& data) {
  double step_N = 0.0;
  if (!data.led_by_drive()) return step_N;
  for (std::size_t k = 1; k < data.size(); ++k) {
    const double change_N = std::fabs(data.reported_N[k] - data.reported_N[k - 1]);
    if (change_N > 1e-9 && (step_N == 0.0 || change_N < step_N)) step_N = change_N;
  }
  return step_N;
}

FollowGain FollowGainFor(const TableAxis& axis, const Measured& data, double factor) {
  const double least = std::min(1.0, 2.0 * std::numbers::pi * kFollow_Hz * factor * data.period_s);
  if (!data.led_by_drive()) return SteadyFollowGain(axis, data.period_s, least * least, 1.0, 0.1);
  const double noise_m = kRoundedNoise * data.position_step_m;
  const double move_m = kRoundedNoise * ReportStep_N(data) * data.period_s * data.period_s / axis.mass_kg();
  const double ratio = factor * factor * std::max(least * least, move_m / std::max(noise_m, 1e-12));
  return SteadyFollowGain(axis, data.period_s, ratio, 0.1, 1.0);
}

Simulation::Simulation(const TableAxis& axis, const Measured& data, const FollowGain& gain)
    : axis_(axis), data_(data), gain_(gain) {
  TableAxis stiff = axis;
  if (axis.two_inertia && axis.side.share > 0.0) {
    const double omega = 2.0 * std::numbers::pi * axis.side.frequency_Hz;
    side_.mass_kg = axis.side.share * axis.load_inertia;
    side_.stiffness_N_m = side_.mass_kg * omega * omega;
    side_.damping_Ns_m = 2.0 * axis.side.damping_ratio * side_.mass_kg * omega;
    stiff.load_inertia -= side_.mass_kg;
  }
  table_mass_kg_ = stiff.load_inertia;
  const bool on_table = axis.friction_on_load;
  const double on_motor = axis.two_inertia && on_table ? axis.motor_friction_share : 0.0;
  Rubbing main;
  main.place = on_table ? 2 : 0;
  main.speed = main.place + 1;
  main.share = 1.0 - on_motor;
  main.mass_kg = on_table ? stiff.load_inertia : stiff.motor_inertia;
  rubbing_.push_back(main);
  if (on_motor > 0.0) {
    Rubbing motor;
    motor.share = on_motor;
    motor.mass_kg = stiff.motor_inertia;
    rubbing_.push_back(motor);
  }
  for (const MotorWave& w : axis.cogging) cogs_ = cogs_ || w.order > 0.0;
  if (data.led_by_drive()) own_ = std::make_unique<OwnForce>(OwnForceOf(axis, data));
  MakePieces(stiff);
  direct_N_.assign(pieces_.size(), 0.0);
}

Simulation::~Simulation() = default;

void Simulation::MakePieces(const TableAxis& stiff) {
  const double delay = std::max(0.0, axis_.delay_s);
  whole_delay_ = static_cast<std::size_t>(delay / data_.period_s + 1e-9);
  const double edge_s = delay - static_cast<double>(whole_delay_) * data_.period_s;
  // Sub-steps of a period, one of them cut in two where the command changes.
  const double h = data_.period_s / kSubSteps;
  const Discrete whole = Over(stiff, axis_.friction.s2, h);
  const auto add = [&](double step_s, bool older) {
    if (step_s < kNoStep_s) return;
    const Discrete d = step_s == h ? whole : Over(stiff, axis_.friction.s2, step_s);
    // Behind the lag the offset is a torque like any other.
    pieces_.push_back({step_s, d.a, d.delayed, d.command, d.motor, d.lag_left, older});
  };
  for (int i = 0; i < kSubSteps; ++i) {
    const double older_s = std::clamp(edge_s - i * h, 0.0, h);
    add(older_s, true);
    add(h - older_s, false);
  }
}

void Simulation::Start() {
  const double here = data_.position_m[k_];
  const double whole_N = (own_ ? data_.reported_N[k_] : data_.force_N[k_]) + axis_.offset;
  force_N_ = own_ ? own_->offset_N[k_] + axis_.offset : whole_N;
  state_ << here, 0.0, !axis_.two_inertia ? here : here - whole_N / axis_.stiffness, 0.0;
  if (k_ > 0 && data_.present[k_ - 1] != 0)
    state_(1) = state_(3) = (here - data_.position_m[k_ - 1]) / data_.period_s;
  const double most = std::min(axis_.friction.Fc_plus, axis_.friction.Fc_minus) / axis_.friction.s0;
  for (Rubbing& r : rubbing_) {
    r.z_m = std::clamp(whole_N / axis_.friction.s0, -most, most);
    r.force_N = BristleForce_N(r);
  }
  side_.place_m = state_(2);
  side_.speed_m_s = state_(3);
  side_.force_N = 0.0;
  running_ = true;
  to_settle_ = static_cast<int>(kSettle_s / data_.period_s);
}

double Simulation::Level_N(double v) const {
  const diagnosis::StatedFriction& f = axis_.friction;
  const bool down = v < 0.0;
  const double fc = down ? f.Fc_minus : f.Fc_plus;
  const double fs = down ? f.Fs_minus : f.Fs_plus;
  const double speed = std::fabs(v) / f.vs;
  const double x = f.exponent == 1.0 ? speed : std::pow(speed, f.exponent);
  const double g = x > kGone ? fc : fc + (fs - fc) * ExpOfNegative(-x);
  return std::max(1e-3, g * (down ? factor_minus_ : factor_plus_));
}

void Simulation::MoveBristle(Rubbing& r, double from_z, double travel_m, double step_s) const {
  const double x = axis_.friction.s0 * std::fabs(travel_m) / Level_N(travel_m / step_s);
  if (x < 1e-9) {
    r.z_m = from_z + travel_m;
  } else if (x > kGone) {
    r.z_m = travel_m / x;
  } else {
    const double gone = -Expm1OfNegative(-x);
    r.z_m = from_z * (1.0 - gone) + travel_m * gone / x;
  }
}

double Simulation::BristleDamping_Ns_m(const Rubbing& r, double v) const {
  const diagnosis::StatedFriction& f = axis_.friction;
  const double x = v / f.vd;
  if (x * x > kGone || f.s1 <= 0.0) return 0.0;
  const double against = (v < 0.0 ? -1.0 : 1.0) * f.s0 * r.z_m / Level_N(v);
  return r.share * f.s1 * ExpOfNegative(-x * x) * (1.0 - against);
}

double Simulation::BristleForce_N(const Rubbing& r) const {
  const double v = state_(r.speed);
  return r.share * axis_.friction.s0 * r.z_m + BristleDamping_Ns_m(r, v) * v;
}

double Simulation::friction_N() const {
  double sum = 0.0;
  for (const Rubbing& r : rubbing_) sum += BristleForce_N(r) + r.share * axis_.friction.s2 * state_(r.speed);
  return sum;
}

void Simulation::Prepare() {
  factor_plus_ = LevelFactor(axis_, state_(0), table_m(), true);
  factor_minus_ = LevelFactor(axis_, state_(0), table_m(), false);
  for (Rubbing& r : rubbing_) {
    r.z_before_m = r.z_m;
    r.place_before_m = state_(r.place);
    r.force_N = BristleForce_N(r);
  }
  if (cogs_) PrepareCogging();
  if (own_) AddOwnForce();
}

/// At the middle of each piece, as if the motor went on at its speed: a rotation from piece to piece.
void Simulation::PrepareCogging() {
  std::fill(direct_N_.begin(), direct_N_.end(), 0.0);
  const double h = data_.period_s / kSubSteps;
  for (const MotorWave& w : axis_.cogging) {
    if (w.order <= 0.0) continue;
    const double per_m = w.order * 2.0 * std::numbers::pi / axis_.turn_m;
    const double first = per_m * (state_(0) + 0.5 * h * state_(1));
    const double turn = per_m * h * state_(1);
    double c = std::cos(first), s = std::sin(first);
    const double dc = std::cos(turn), ds = std::sin(turn);
    double from_s = 0.0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      direct_N_[i] += w.cosine_N * c + w.sine_N * s;
      from_s += pieces_[i].step_s;
      // Both parts of the sub-step that the delay cuts have the same.
      if (std::fmod(from_s + kNoStep_s, h) > 2.0 * kNoStep_s) continue;
      const double next = c * dc - s * ds;
      s = s * dc + c * ds;
      c = next;
    }
  }
}

void Simulation::AddOwnForce() {
  if (!cogs_) std::fill(direct_N_.begin(), direct_N_.end(), 0.0);
  double from_s = 0.0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double to_s = from_s + pieces_[i].step_s;
    direct_N_[i] += PartOfPeriod_N(own_->at_N[k_], own_->at_N[k_ + 1], own_->mean_N[k_],
                                   from_s / data_.period_s, to_s / data_.period_s);
    from_s = to_s;
  }
}

/// Half a step of what swings on the table, and of the table under it.
void Simulation::Swing(double half_step_s) {
  side_.force_N =
      side_.stiffness_N_m * (state_(2) - side_.place_m) + side_.damping_Ns_m * (state_(3) - side_.speed_m_s);
  side_.speed_m_s += half_step_s / side_.mass_kg * side_.force_N;
  state_(3) -= half_step_s / table_mass_kg_ * side_.force_N;
}

void Simulation::Advance(const Piece& p, double command_N, double motor_N) {
  if (side_.mass_kg > 0.0) {
    Swing(0.5 * p.step_s);
    side_.place_m += 0.5 * p.step_s * side_.speed_m_s;
  }
  double from_m[2];
  for (std::size_t i = 0; i < rubbing_.size(); ++i) {
    const Rubbing& r = rubbing_[i];
    state_(r.speed) -= 0.5 * p.step_s / r.mass_kg * r.force_N;
    from_m[i] = state_(r.place);
  }
  state_ = p.flow * state_ + p.delayed * force_N_ + p.command * command_N;
  if (cogs_ || own_) state_ += p.motor * motor_N;
  force_N_ = command_N + (force_N_ - command_N) * p.lag_left;
  for (std::size_t i = 0; i < rubbing_.size(); ++i) {
    Rubbing& r = rubbing_[i];
    const double kick = 0.5 * p.step_s / r.mass_kg;
    MoveBristle(r, r.z_m, state_(r.place) - from_m[i], p.step_s);
    // Damping takes the velocity after the kick, or the scheme would be of first order in it.
    const double elastic = r.share * axis_.friction.s0 * r.z_m;
    const double before = state_(r.speed);
    const double damping = BristleDamping_Ns_m(r, before - kick * elastic);
    state_(r.speed) = (before - kick * elastic) / (1.0 + kick * damping);
    r.force_N = elastic + damping * state_(r.speed);
  }
  if (side_.mass_kg > 0.0) {
    side_.place_m += 0.5 * p.step_s * side_.speed_m_s;
    Swing(0.5 * p.step_s);
  }
}

double Simulation::Next() {
  const std::size_t k = k_;
  if (!running_) {
    if (k < data_.size() && data_.present[k] != 0) Start();
    if (!running_) {
      ++k_;
      return kNoValue;
    }
  }
  Prepare();
  const std::size_t now = k >= whole_delay_ ? k - whole_delay_ : 0;
  const std::vector<double>& sent_N = own_ ? data_.offset_N : data_.force_N;
  const double newer = sent_N[now] + axis_.offset;
  const double older = sent_N[now > 0 ? now - 1 : 0] + axis_.offset;
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    Advance(pieces_[i], pieces_[i].older ? older : newer, direct_N_[i]);
  ++k_;
  if (k_ >= data_.size() || data_.present[k_] == 0) {
    // Nobody knows what was commanded in a long gap: begin anew behind it.
    if (++absent_ > kLongestGap) running_ = false;
    return kNoValue;
  }
  absent_ = 0;
  const double error = data_.position_m[k_] - state_(0);
  Correct(error);
  if (to_settle_ > 0) {
    --to_settle_;
    return kNoValue;
  }
  return error;
}

void Simulation::Correct(double error_m) {
  const Eigen::Vector4d predicted = state_;
  state_ += gain_ * error_m;
  if (side_.mass_kg > 0.0) {
    side_.place_m += gain_(2) * error_m;
    side_.speed_m_s += gain_(3) * error_m;
  }
  for (Rubbing& r : rubbing_) {
    const double travel_m = predicted(r.place) - r.place_before_m;
    if (std::fabs(travel_m) > kMoving_m_s * data_.period_s) {
      // The correction is a little more, or less, of the travel just made.
      const double spent = axis_.friction.s0 * r.z_m / Level_N(travel_m / data_.period_s);
      r.z_m += gain_(r.place) * error_m * (1.0 - (travel_m < 0.0 ? -spent : spent));
    } else {
      // Standing: the period's travel once more, to where the correction puts the mass. As a travel of its
      // own the correction's noise would relax the bristle.
      MoveBristle(r, r.z_before_m, state_(r.place) - r.place_before_m, data_.period_s);
    }
    // While the axis stands, trembling relaxes the bristle a little otherwise than predicted, and no travel
    // would ever show it: the lasting error that this leaves pulls it back, within some 50 ms.
    r.z_m -= kBristleCorrection * error_m;
  }
}

double LevelFactor(const TableAxis& axis, double motor_m, double table_m, bool up) {
  const LevelVariation& v = axis.variation;
  const double angle = axis.turn_m > 0.0 ? 2.0 * std::numbers::pi * motor_m / axis.turn_m : 0.0;
  const double turn = Harmonics(up ? v.turn_plus : v.turn_minus, std::cos(angle), std::sin(angle));
  return std::max(0.1, (1.0 + Place(v, table_m)) * (1.0 + turn));
}

std::vector<double> PredictionErrors_m(const TableAxis& axis, const Measured& data, const FollowGain& gain) {
  std::vector<double> errors(data.size(), 0.0);
  Simulation simulation(axis, data, gain);
  for (std::size_t k = 0; k + 1 < data.size(); ++k) {
    const double e = simulation.Next();
    if (std::isfinite(e)) errors[k + 1] = e;
  }
  return errors;
}

}  // namespace contour::identify
