#include "estimator/seven_state_filter.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "estimator/share_of_period.h"

namespace contour {
namespace {

// Presliding: the bristle is well below the level it would slip at.
constexpr double kPreslidingShare = 0.7;
// A bristle below this share of the level after so many presliding lengths of travel: the level is not there.
// Even with a third of the commissioned stiffness a real one has come to 1 - exp(-4/3) = 0.74 by then.
constexpr double kMissingShare = 0.3;
constexpr double kSettledLengths = 4.0;
constexpr double kSettled_s = 0.05;
// By how much the level then comes down per presliding length.
constexpr double kGivingUpShare = 0.3;
// What must hold the axis back for a level that was given up to be taken back, in doubts.
constexpr double kTakenBackDoubts = 4.0;
// Standard deviation of a level, at most this share of it.
constexpr double kLargestLevelStd = 0.25;
// Lowest level, of the commissioned one: an axis may turn out to have hardly any friction.
constexpr double kLowestLevelShare = 1e-4;
// To a filter a level is a number like any other, and a jerk's innovation may take it to nothing at once. One
// reading takes it to this share of the commissioned one, or to that of what it was.
constexpr double kLeastByReading = 0.1;
constexpr double kLeastLeft = 0.25;

// A drive reports rounded torque, of the instant of the sample: its mean over the period is less certain.
constexpr double kReportedTorqueNoise = 3.0;
// It lies anywhere between the two reports: of what it differs from their mean by at most, one in root three.
constexpr double kBetweenReports = 1.0 / std::numbers::sqrt3;

// Where the drive holds the axis a level that is wrong at rest swings nothing, and may follow a drift faster:
// with friction that rises by 60 % in a minute under a constant force the error grew to 2.2 times without it,
// to 1.9 times with it. Twice as much stated too little of what levels are off by (base, C: inside 0.89 of
// the time).
constexpr double kReportedLevelNoise = 1.5;

// Friction that the filter does not foresee, along the turn for one, it follows late, and what it is late by
// its covariance does not have. The disturbance shows it: of its mean square, that share. Squares of seven
// axes in csp: inside two stated deviations 0.78 of the time without, 0.91 with it.
constexpr double kUnforeseen = 0.1;

// Largest factor on the noise of parameters and disturbance for a coarse encoder.
constexpr double kMostCoarse = 7.0;

// Once there is a lasting force, all of the disturbance becomes part of it at this share per millisecond.
constexpr double kLastingRate = 0.002;
// Asymmetry moves over to it by this share of what is allowed per millisecond.
constexpr double kShareRate = 0.02;
constexpr double kGivenUpShare = 0.2;
constexpr double kComingDownShare = 0.5;

// What is frozen leaves the learnt stiffness by this share per millisecond.
constexpr double kForgetShare = 0.02;

// Mean of the squared, normalised innovations; share per millisecond.
constexpr double kSurpriseShare = 0.01;

// The centre of mass runs ahead of the table by (1 - Mt/m) of the wind-up F / K.
double AheadOfTable(const Mechanics& m) noexcept {
  return (1.0 - m.table_mass_kg / m.mass_kg) / m.stiffness_N_m;
}

}  // namespace

template <class Core>
SevenStateFilter<Core>::SevenStateFilter(const FilterSetup& setup) noexcept
    : setup_(setup),
      model_(setup.friction, setup.mechanics.mass_kg, setup.period_s,
             setup.config.disturbance_decay_ms * 1e-3, AheadOfTable(setup.mechanics)),
      lag_(setup.period_s, setup.lag_s),
      gate_({setup.config.innovation_gate_sigma, setup.config.innovation_gate_um * 1e-6}, setup.Sudden_m()),
      lasting_share_(ShareOfPeriod(kLastingRate, setup.period_s)),
      asymmetry_share_(ShareOfPeriod(kShareRate, setup.period_s)),
      surprise_share_(ShareOfPeriod(kSurpriseShare, setup.period_s)),
      band_(setup.config.initial_level_std * setup.Coulomb_N(), setup.period_s),
      forget_share_(ShareOfPeriod(kForgetShare, setup.period_s)) {
  const auto& c = setup.config;
  // A coarse encoder would slow the parameters down with the rest of the filter, more than their drift
  // allows.
  const double coarse = std::min(setup.measurement_std_m / (c.measurement_noise_um * 1e-6), kMostCoarse);
  noise_[kPosition] = setup.PerPeriod(c.position_noise_um * 1e-6);
  noise_[kVelocity] = setup.PerPeriod(c.velocity_noise_mm_s * 1e-3) * std::sqrt(coarse);
  if (setup.reported_torque) noise_[kVelocity] *= kReportedTorqueNoise;
  const double accelerated_s_kg = setup.period_s / setup.mechanics.mass_kg;
  timing_noise_s_kg_ =
      accelerated_s_kg * std::hypot(c.timing_noise, setup.reported_torque ? kBetweenReports : 0.0);
  const double coulomb_N = setup.Coulomb_N();
  // A force from outside is no friction: an axis that has next to none is to find it as fast as others do.
  const double disturbance_N = c.disturbance_noise_mm_s2 * 1e-3 * setup.mechanics.mass_kg;
  noise_[kBristle] = setup.PerPeriod(c.bristle_noise_rel * coulomb_N);
  noise_[kDisturbance] = setup.PerPeriod(disturbance_N) * coarse;
  noise_[kLevelPlus] = setup.PerPeriod(c.level_noise_rel * coulomb_N) * coarse;
  if (setup.reported_torque) noise_[kLevelPlus] *= kReportedLevelNoise;
  noise_[kLevelMinus] = noise_[kLevelPlus];
  noise_[kLogSigma0] = setup.PerPeriod(c.log_sigma0_noise) * coarse;
  motion_gate_m_s_ = c.motion_gate_mm_s * 1e-3;
  mass_std_kg_ = c.mass_std * setup.mechanics.mass_kg;
  mass_noise_s2_kg2_ = setup.reported_torque ? accelerated_s_kg * accelerated_s_kg : 0.0;

  const Friction& f = setup.friction;
  initial_std_[kPosition] = setup.measurement_std_m;
  initial_std_[kVelocity] = 1e-4;
  initial_std_[kBristle] = 0.5 * std::max(f.Fs_plus_N, f.Fs_minus_N);
  initial_std_[kDisturbance] = disturbance_N;
  initial_std_[kLevelPlus] = c.initial_level_std * f.Fc_plus_N;
  initial_std_[kLevelMinus] = c.initial_level_std * f.Fc_minus_N;
  initial_std_[kLogSigma0] = c.initial_log_sigma0_std;
  if (!c.adapt) {
    for (const auto i : {kLevelPlus, kLevelMinus, kLogSigma0}) noise_[i] = initial_std_[i] = 0.0;
  }

  // Beyond these the covariance says nothing any more.
  std_limit_ = {1.0, 100.0, 1e5, 1e5, 1e5, 1e5, 1e3};
  Reset(0.0);
}

template <class Core>
void SevenStateFilter<Core>::Reset(double position_m) noexcept {
  core_.x = {};
  core_.x[kLevelPlus] = setup_.friction.Fc_plus_N;
  core_.x[kLevelMinus] = setup_.friction.Fc_minus_N;
  core_.s = {};
  for (std::size_t i = 0; i < kSevenStates; ++i) core_.s[i][i] = initial_std_[i];
  sigma0_N_m_ = model_.Sigma0_N_m(core_.x);
  band_.Reset();
  last_position_m_ = position_m;
  periods_since_position_ = 1.0;
  Follow(position_m);
}

// Position and velocity from the encoder, bristle unknown, parameters kept.
template <class Core>
void SevenStateFilter<Core>::Follow(double position_m) noexcept {
  auto& x = core_.x;
  const Mechanics& m = setup_.mechanics;
  const double table_share = m.table_mass_kg / m.mass_kg;
  x[kPosition] = position_m + table_share * (1.0 - table_share) * table_now_N_ / m.stiffness_N_m;
  x[kVelocity] = (position_m - last_position_m_) / (setup_.period_s * periods_since_position_);
  x[kBristle] = 0.0;
  x[kDisturbance] = 0.0;
  X std = initial_std_;
  for (const auto i : {kLevelPlus, kLevelMinus, kLogSigma0}) std[i] = std::sqrt(core_.Variance(i));
  core_.s = {};
  for (std::size_t i = 0; i < kSevenStates; ++i) core_.s[i][i] = std[i];
  surprise_ = 1.0;
  lasting_N_ = 0.0;
  direction_ = travel_direction_ = 0;
  travel_m_ = travel_s_ = 0.0;
  lag_.Reset();
  at_ = model_.TermsAt(x[kVelocity]);
  predicted_ = x;
  gated_in_a_row_ = 0;
  gate_.Reset();
  following_ = true;
}

// The encoder sees the motor; the model moves the centre of mass, which trails it by Mt/m of the screw's
// wind-up (F + sigma2 v - Ft + Mt a) / K, Ft what is known to pull at the table.
template <class Core>
double SevenStateFilter<Core>::WindUpShare_m(double total_N, double disturbance_N, double force_N,
                                             double table_N) const noexcept {
  const Mechanics& m = setup_.mechanics;
  const double friction = total_N - disturbance_N - table_N;
  const double acceleration = (force_N + driving_N_ - inertial_N_ - total_N) / m.mass_kg;
  return m.table_mass_kg / m.mass_kg * (friction + m.table_mass_kg * acceleration) / m.stiffness_N_m;
}

// At a reversal, what d holds turns round with the friction if it was friction. As much as may be an error of
// the level goes over to the bristle, which will follow its new level from there; their sum stays. More than
// that is an outside force, which does not care for the direction.
template <class Core>
void SevenStateFilter<Core>::Reverse(double commanded_velocity_m_s) noexcept {
  const int direction = commanded_velocity_m_s > 0.0 ? 1 : commanded_velocity_m_s < 0.0 ? -1 : 0;
  if (direction == 0 || direction == direction_) return;
  if (direction_ != 0) {
    auto& x = core_.x;
    const double largest_N = setup_.config.level_error * Level_N();
    const double friction_N = std::clamp(x[kDisturbance] - lasting_N_, -largest_N, largest_N);
    x[kBristle] += friction_N;
    x[kDisturbance] -= friction_N;
  }
  direction_ = direction;
}

template <class Core>
CONTOUR_WIDE_VECTORS void SevenStateFilter<Core>::TimeUpdate(const AxisEstimatorInput& in) noexcept {
  auto& x = core_.x;
  Reverse(in.commanded_velocity_m_s);
  driving_N_ = driving_before_N_;
  const double moving = std::min(1.0, std::abs(x[kVelocity]) / motion_gate_m_s_);
  X noise = noise_;
  noise[kDisturbance] *= moving;
  if (in.at_rest) noise[kBristle] *= setup_.config.rest_noise;
  // What stirs the bristle comes from the surfaces that make the level. Without friction it is still.
  noise[kBristle] *= std::min(1.0, 2.0 * x[LevelState()] / CommissionedLevel_N());
  // A torque that changes fast acts for a time, and on a mass, known less well than a steady one does.
  const double timing_m_s = timing_noise_s_kg_ * (in.force_N[1] - in.force_N[2]);
  noise[kVelocity] = std::sqrt(noise[kVelocity] * noise[kVelocity] + timing_m_s * timing_m_s +
                               mass_noise_s2_kg2_ * mass_N2_);
  const auto adapted = Adapted(in.at_rest);
  for (const auto i : {kLevelPlus, kLevelMinus, kLogSigma0}) noise[i] *= adapted[i] ? moving : 0.0;

  const SevenStateInput input = Input(at_, lag_.Step(in.force_N[1]));
  if constexpr (requires { core_.Draw(std::declval<SigmaPoints<kSevenStates>&>()); }) {
    core_.template Predict<kMovingStates>(
        [&](SigmaPoints<kSevenStates>& points) noexcept { model_.Propagate(points, input, at_.low_speed); },
        noise);
  } else {
    core_.Predict(
        [&](X& mean, SquareMatrix<kSevenStates>& t) noexcept { model_.PropagateTangent(mean, t, input); },
        noise);
  }
  at_ = model_.TermsAt(x[kVelocity]);
}

template <class Core>
StateMask<kSevenStates> SevenStateFilter<Core>::Adapted(bool at_rest) const noexcept {
  auto mask = AllStates<kSevenStates>();
  const auto& x = core_.x;
  const bool moving = !at_rest && adapts();
  const bool forward = x[kVelocity] >= 0.0;
  mask[kLevelPlus] = moving && forward;
  mask[kLevelMinus] = moving && !forward;
  mask[kLogSigma0] = moving && std::abs(x[kBristle]) < kPreslidingShare * Level_N();
  return mask;
}

template <class Core>
CONTOUR_WIDE_VECTORS UpdateResult SevenStateFilter<Core>::MeasurementUpdate(const AxisEstimatorInput& in,
                                                                            Innovation& innovation) noexcept {
  auto& x = core_.x;
  const double y =
      in.position_m - WindUpShare_m(Total_N(x, at_), x[kDisturbance], lag_.force_N(), table_now_N_);
  const Friction& f = setup_.friction;
  const double least_plus_N = std::min(kLeastLeft * x[kLevelPlus], kLeastByReading * f.Fc_plus_N);
  const double least_minus_N = std::min(kLeastLeft * x[kLevelMinus], kLeastByReading * f.Fc_minus_N);
  const UpdateResult result =
      core_.UpdateState0(y, setup_.measurement_std_m, gate_.gate(), Adapted(in.at_rest), innovation);
  gate_.After(innovation.value, innovation.std);
  x[kLevelPlus] = std::max(x[kLevelPlus], least_plus_N);
  x[kLevelMinus] = std::max(x[kLevelMinus], least_minus_N);
  at_ = model_.TermsAt(x[kVelocity]);
  return result;
}

// After some presliding lengths g / sigma0 of travel in one direction the bristle has come to the level:
// F = g (1 - exp(-sigma0 x / g)). If it stays far below, there is not that much friction, but the filter
// cannot see that by itself: far from the level, F does not depend on it (dF/dg = 0 at F = 0). So the level
// comes down by travel. Nor does a level of nearly nothing come up again by itself: it is taken from what
// holds the axis back.
template <class Core>
void SevenStateFilter<Core>::JudgeLevel(bool at_rest) noexcept {
  auto& x = core_.x;
  const int direction = LevelState() == kLevelPlus ? 1 : -1;
  if (direction != travel_direction_) {
    travel_direction_ = direction;
    travel_m_ = travel_s_ = 0.0;
  }
  const double step_m = std::abs(x[kVelocity]) * setup_.period_s;
  travel_m_ += step_m;
  travel_s_ += setup_.period_s;
  if (at_rest || !adapts()) return;
  const double level_N = Level_N();
  // By the commissioned stiffness: the estimated one goes down instead of the level when there is no
  // friction.
  const double length_m = level_N / setup_.friction.sigma0_N_m;
  // A disturbance as small as an error of the level would be is an error of the level.
  const double doubt_N = setup_.config.level_error * CommissionedLevel_N();
  const double held_N =
      direction * (x[kBristle] + std::clamp(x[kDisturbance] - lasting_N_, -doubt_N, doubt_N));
  double& level = x[LevelState()];
  // A jerk may take the axis over all the lengths before the filter has seen what held it back.
  const bool settled = travel_m_ > kSettledLengths * length_m && travel_s_ > kSettled_s;
  // A drive that holds the axis by itself, with a wrong mass in the model, looks like a missing level.
  if (!setup_.reported_torque && settled && held_N <= kMissingShare * level_N) {
    level *= std::exp(-kGivingUpShare * step_m / length_m);
    // Nothing to act upon is left of it.
    if (level < doubt_N) level = kLowestLevelShare * CommissionedLevel_N();
    // The bristle comes down with its level; what it held besides was no friction.
    const double lowered_N = Level_N();
    const double excess_N = x[kBristle] - std::clamp(x[kBristle], -lowered_N, lowered_N);
    x[kBristle] -= excess_N;
    x[kDisturbance] += excess_N;
  } else if (travel_m_ > kSettledLengths * CommissionedLevel_N() / setup_.friction.sigma0_N_m) {
    TakeLevelBack(direction * (x[kBristle] + x[kDisturbance] - lasting_N_), kTakenBackDoubts * doubt_N);
  }
}

template <class Core>
void SevenStateFilter<Core>::TakeLevelBack(double held_N, double least_N) noexcept {
  if (held_N < least_N || Level_N() > kMissingShare * held_N) return;
  auto& x = core_.x;
  const std::size_t i = LevelState();
  x[i] *= held_N / Level_N();
  x[kBristle] += x[kDisturbance] - lasting_N_;
  x[kDisturbance] = lasting_N_;
  const double share = initial_std_[i] / std::sqrt(core_.Variance(i));
  for (double& s : core_.s[i]) s *= share;
}

// Beyond what an error of the level may be, a disturbance is a force from outside. It does not fade, or the
// levels would have to take it up, of which one would come down to nothing.
template <class Core>
void SevenStateFilter<Core>::HoldLastingForce() noexcept {
  const double room_N = setup_.config.lasting_force * CommissionedLevel_N();
  const double beyond_N = core_.x[kDisturbance] - lasting_N_;
  lasting_N_ += beyond_N - std::clamp(beyond_N, -room_N, room_N);
  if (std::abs(lasting_N_) > room_N) lasting_N_ += lasting_share_ * (core_.x[kDisturbance] - lasting_N_);
}

// A force from outside and levels that differ by as much between the directions are the same to one encoder.
// More asymmetry than a model may lack is such a force.
template <class Core>
void SevenStateFilter<Core>::ShareAsymmetry() noexcept {
  auto& x = core_.x;
  const Friction& f = setup_.friction;
  const double most_N = setup_.config.level_asymmetry * 0.5 * (f.Fc_plus_N + f.Fc_minus_N);
  const double asymmetry_N = 0.5 * ((x[kLevelPlus] - f.Fc_plus_N) - (x[kLevelMinus] - f.Fc_minus_N));
  const double beyond_N = asymmetry_N - std::clamp(asymmetry_N, -most_N, most_N);
  const double excess_N = std::clamp(beyond_N, -asymmetry_share_ * most_N, asymmetry_share_ * most_N);
  x[kLevelPlus] -= excess_N;
  x[kLevelMinus] += excess_N;
  x[kBristle] -= excess_N;
  x[kDisturbance] += excess_N;
  lasting_N_ += excess_N;
}

template <class Core>
bool SevenStateFilter<Core>::Bound() noexcept {
  bool bounded = false;
  const auto clamp = [&bounded](double& value, double low, double high) {
    if (value < low || value > high) {
      value = std::clamp(value, low, high);
      bounded = true;
    }
  };
  const auto& c = setup_.config;
  const Friction& f = setup_.friction;
  auto& x = core_.x;
  clamp(x[kLevelPlus], f.Fc_plus_N * kLowestLevelShare, f.Fc_plus_N * c.level_range);
  clamp(x[kLevelMinus], f.Fc_minus_N * kLowestLevelShare, f.Fc_minus_N * c.level_range);
  clamp(x[kLogSigma0], -c.log_sigma0_range, c.log_sigma0_range);
  // No bristle holds more than the largest level: the rest is a force from outside.
  const double most_N = c.level_range * std::max(f.Fs_plus_N, f.Fs_minus_N);
  const double rest_N = x[kBristle] - std::clamp(x[kBristle], -most_N, most_N);
  x[kBristle] -= rest_N;
  x[kDisturbance] += rest_N;
  // A level is positive: its sigma points must be too. Scaling a row of S scales that state's deviation and
  // keeps its correlations.
  for (const auto i : {kLevelPlus, kLevelMinus}) {
    const double share = kLargestLevelStd * x[i] / std::sqrt(core_.Variance(i));
    if (share < 1.0)
      for (double& s : core_.s[i]) s *= share;
  }
  return bounded;
}

template <class Core>
void SevenStateFilter<Core>::LookAhead(const AxisEstimatorInput& in) noexcept {
  driving_N_ = driving_ahead_N_;
  predicted_ = core_.x;
  model_.Propagate(predicted_, Input(at_, lag_.Look(in.force_N[0])), at_.low_speed, sigma0_N_m_);
  if (!setup_.looks_ahead) return;
  // On to the end of [t(k), t(k+1)), for the middle of it. The torque that acts there is being computed: the
  // newest stands for it.
  const SpeedTerms begin_at = model_.TermsAt(predicted_[kVelocity]);
  X end = predicted_;
  model_.Propagate(end, Input(begin_at, {in.force_N[0], in.force_N[0]}), begin_at.low_speed, sigma0_N_m_);
  const SpeedTerms end_at = model_.TermsAt(end[kVelocity]);
  friction_ahead_N_ = 0.5 * (model_.Friction_N(predicted_, begin_at, Input(begin_at, {})) +
                             model_.Friction_N(end, end_at, Input(end_at, {})));
}

// Only ratios of the noises set the gains, so what is stated of them may be too much by any factor:
// innovations say by how much, and where they are larger (a wrong model) they widen the band. A wrong mass is
// seen by nothing but the acceleration it is multiplied with.
template <class Core>
double SevenStateFilter<Core>::FrictionStd_N() const noexcept {
  const double filter_N2 =
      core_.Variance({0.0, model_.sigma2_Ns_m(), 1.0, 1.0, 0.0, 0.0, 0.0}, kVelocity, kLevelPlus);
  return std::sqrt(surprise_ * filter_N2 + mass_N2_ + kUnforeseen * band_.MeanSquare_N2());
}

template <class Core>
CONTOUR_WIDE_VECTORS void SevenStateFilter<Core>::Tell(const AxisEstimatorInput& in,
                                                       AxisEstimate& out) noexcept {
  const auto& x = core_.x;
  sigma0_N_m_ = model_.Sigma0_N_m(x);
  LookAhead(in);

  const double friction_N = Total_N(x, at_);
  const double ahead_N = Total_N(predicted_, model_.TermsAt(predicted_[kVelocity]));
  out.position_m = x[kPosition] + WindUpShare_m(friction_N, x[kDisturbance], lag_.force_N(), table_now_N_);
  out.velocity_m_s = x[kVelocity];
  out.predicted_position_m =
      predicted_[kPosition] + WindUpShare_m(ahead_N, predicted_[kDisturbance], in.force_N[0], table_ahead_N_);
  out.predicted_velocity_m_s = predicted_[kVelocity];
  out.bristle_N = x[kBristle];
  out.disturbance_N = x[kDisturbance];
  if (in.enabled && !in.at_rest) band_.Step(x[kDisturbance]);
  out.disturbance_std_N = band_.Std_N(surprise_ * core_.Variance(kDisturbance));
  out.friction_N = friction_N;
  out.friction_std_N = FrictionStd_N();
  out.g_plus_N = x[kLevelPlus];
  out.g_minus_N = x[kLevelMinus];
  out.sigma0_N_m = sigma0_N_m_;
  out.diverged = !square_root::Sound(core_.x, core_.s, std_limit_);
}

template <class Core>
AxisEstimate SevenStateFilter<Core>::Update(const AxisEstimatorInput& in) noexcept {
  AxisEstimate out;
  at_rest_ = in.at_rest;
  periods_since_position_ += 1.0;
  const double stated_N = mass_std_kg_ * in.commanded_acceleration_m_s2;
  mass_N2_ = mass_variance_left_ * (stated_N * stated_N + inertial_N_ * inertial_N_);
  if (!in.enabled) {
    if (in.fresh) Follow(in.position_m);
  } else {
    if (!following_) TimeUpdate(in);
    following_ = false;
    Innovation innovation;
    if (in.fresh) {
      const UpdateResult result = MeasurementUpdate(in, innovation);
      gated_in_a_row_ = result == UpdateResult::kGated ? gated_in_a_row_ + 1 : 0;
      if (result == UpdateResult::kOk) {
        const double ratio = innovation.value / innovation.std;
        // A reading that stands says nothing of how well friction is known.
        const double least = in.at_rest ? std::min(1.0, surprise_) : 0.0;
        surprise_ += surprise_share_ * (std::max(least, ratio * ratio) - surprise_);
      }
      if (result == UpdateResult::kGated) out.limit = Reason::kInnovationGated;
      if (gated_in_a_row_ != 0 && StartsAgain(gated_in_a_row_, setup_.period_s)) Follow(in.position_m);
    }
    out.innovation_m = innovation.value;
    out.innovation_std_m = innovation.std;
    // What a corner or a fast reversal left of it may be anything, and at rest the axis stands by it.
    if (frozen_ || in.at_rest) core_.x[kLogSigma0] -= forget_share_ * core_.x[kLogSigma0];
    JudgeLevel(in.at_rest);
    const bool bounded = Bound();
    if (!in.at_rest && adapts()) {
      const Friction& f = setup_.friction;
      const double plus = core_.x[kLevelPlus] / f.Fc_plus_N, minus = core_.x[kLevelMinus] / f.Fc_minus_N;
      // Without any level there is nothing to tell an outside force from: it may be friction that comes back.
      if (std::max(plus, minus) < kGivenUpShare) {
        lasting_N_ = 0.0;
      } else {
        HoldLastingForce();
        // A level that comes down where there is no outside force is being given up; the other one will be
        // next.
        if (lasting_N_ != 0.0 || std::min(plus, minus) > kComingDownShare) ShareAsymmetry();
      }
    }
    if (bounded && out.limit == Reason::kNone) out.limit = Reason::kParameterBound;
  }
  if (in.fresh) {
    last_position_m_ = in.position_m;
    periods_since_position_ = 0.0;
  }
  Tell(in, out);
  return out;
}

template class SevenStateFilter<SqrtUkf<kSevenStates>>;
template class SevenStateFilter<SqrtEkf<kSevenStates>>;

}  // namespace contour
