#include "estimator/seven_state_filter.h"

#include <limits>

#include "estimator/share_of_period.h"

namespace contour {
namespace {

// To a filter a level is a number like any other, and a jerk's innovation may take it to nothing at once. One
// reading takes it to this share of the commissioned one, or to that of what it was.
constexpr double kLeastByReading = 0.1;
constexpr double kLeastLeft = 0.25;

// Once there is a lasting force, all of the disturbance becomes part of it at this share per millisecond.
constexpr double kLastingRate = 0.002;
// Asymmetry moves over to it by this share of what is allowed per millisecond.
constexpr double kShareRate = 0.02;

// A drive reports rounded torque, of the instant of the sample: its mean over the period is less certain.
constexpr double kReportedTorqueNoise = 3.0;

// Of the velocity that an axis which begins to be followed has, in Stribeck velocities.
constexpr double kInitialSpeed = 0.05;

// Largest factor on the noise of parameters and disturbance for a coarse encoder.
constexpr double kMostCoarse = 7.0;

// One reading moves the stiffness no further than one that is off by so many standard deviations: beyond, it
// is the model that is wrong, and not by its stiffness.
constexpr double kMostInfluence = 3.0;
// What is frozen leaves the learnt stiffness by this share per millisecond, and so does what rests one that
// was not seen to its end.
constexpr double kForgetShare = 0.02;

// Mean of the squared, normalised innovations; share per millisecond.
constexpr double kSurpriseShare = 0.01;
// However well the filter predicts, its friction is no better known than by
// 0.45 of what its covariance says.
constexpr double kLeastSurprise = 0.2;

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
      gate_({setup.config.innovation_gate_sigma, setup.config.innovation_gate_um * 1e-6}),
      evidence_({setup.friction.sigma0_N_m, setup.mechanics.mass_kg, setup.config.mass_std,
                 setup.config.timing_noise, setup.period_s}),
      lasting_share_(ShareOfPeriod(kLastingRate, setup.period_s)),
      asymmetry_share_(ShareOfPeriod(kShareRate, setup.period_s)),
      surprise_share_(ShareOfPeriod(kSurpriseShare, setup.period_s)),
      forget_share_(ShareOfPeriod(kForgetShare, setup.period_s)) {
  const auto& c = setup.config;
  // A coarse encoder would slow the parameters down with the rest of the filter, more than their drift
  // allows.
  const double coarse = std::min(setup.measurement_std_m / (c.measurement_noise_um * 1e-6), kMostCoarse);
  const AxisNoise noise = setup.Noise();
  gate_m_s_ = noise.gate_m_s;
  noise_[kPosition] = setup.PerPeriod(c.position_noise_um * 1e-6);
  noise_[kVelocity] = setup.PerPeriod(noise.velocity_m_s) * std::sqrt(coarse);
  if (setup.reported_torque) noise_[kVelocity] *= kReportedTorqueNoise;
  noise_[kBristle] = setup.PerPeriod(noise.bristle_N);
  noise_[kDisturbance] = setup.PerPeriod(noise.disturbance_N) * coarse;
  noise_[kLevelPlus] = setup.PerPeriod(noise.level_N) * coarse;
  noise_[kLevelMinus] = noise_[kLevelPlus];
  noise_[kLogSigma0] = setup.PerPeriod(c.log_sigma0_noise) * coarse;

  const Friction& f = setup.friction;
  initial_std_[kPosition] = setup.measurement_std_m;
  initial_std_[kVelocity] = kInitialSpeed * f.vs_m_s;
  initial_std_[kBristle] = 0.5 * std::max(f.Fs_plus_N, f.Fs_minus_N);
  initial_std_[kDisturbance] = noise.disturbance_N;
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
  evidence_.Reset();
  last_position_m_ = position_m;
  periods_since_position_ = 1.0;
  Follow(position_m);
}

// Position and velocity from the encoder, bristle unknown, parameters kept.
template <class Core>
void SevenStateFilter<Core>::Follow(double position_m) noexcept {
  auto& x = core_.x;
  x[kPosition] = position_m;
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
  evidence_.Rest();
  lag_.Reset();
  at_ = model_.TermsAt(x[kVelocity]);
  predicted_ = x;
  gated_in_a_row_ = 0;
  gate_.Reset();
  following_ = true;
}

// The encoder sees the motor; the model moves the centre of mass, which trails it by Mt/m of the screw's
// wind-up (F + sigma2 v + Mt a) / K.
template <class Core>
double SevenStateFilter<Core>::WindUpShare_m(double total_N, double disturbance_N,
                                             double force_N) const noexcept {
  const Mechanics& m = setup_.mechanics;
  const double friction = total_N - disturbance_N;
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
  const double moving = std::min(1.0, std::abs(x[kVelocity]) / gate_m_s_);
  X noise = noise_;
  noise[kDisturbance] *= moving;
  if (in.at_rest) noise[kBristle] *= setup_.config.rest_noise;
  // What stirs the bristle comes from the surfaces that make the level. Without friction it is still.
  noise[kBristle] *= std::min(1.0, 2.0 * x[LevelState()] / CommissionedLevel_N());
  // A torque that changes fast acts for a time, and on a mass, known less well than a steady one does.
  const double uncertain_N = setup_.config.timing_noise * (in.force_N[1] - in.force_N[2]);
  const double uncertain_m_s = uncertain_N * setup_.period_s / setup_.mechanics.mass_kg;
  noise[kVelocity] = std::sqrt(noise[kVelocity] * noise[kVelocity] + uncertain_m_s * uncertain_m_s);
  const auto adapted = Adapted(in.at_rest);
  for (const auto i : {kLevelPlus, kLevelMinus, kLogSigma0}) noise[i] *= adapted[i] ? moving : 0.0;

  // Where sigma0 does not show, nothing is to follow from what it is uncertain by: sigma points with other
  // stiffnesses pull the mean of a bristle that turns round faster than it can be seen.
  auto& row = core_.s[kLogSigma0];
  const double log_sigma0_std = std::sqrt(core_.Variance(kLogSigma0));
  if (!evidence_.matters()) row = {};
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
  if (!evidence_.matters()) row[kLogSigma0] = log_sigma0_std;
  at_ = model_.TermsAt(x[kVelocity]);
}

// A stiffness that nothing has confirmed is not what an axis is to stand on.
template <class Core>
void SevenStateFilter<Core>::JudgeStiffness(const AxisEstimatorInput& in, double surprise) noexcept {
  double& log_sigma0 = core_.x[kLogSigma0];
  if (frozen_) evidence_.Forget();
  if (in.at_rest || !adapts()) {
    evidence_.Rest();
    if (in.at_rest && adapts()) LeaveBounds();
    log_sigma0 += forget_share_ * (evidence_.kept() - log_sigma0);
    return;
  }
  evidence_.See({LevelState() == kLevelPlus, core_.x[kBristle], Level_N(), core_.x[kVelocity], travel_m_,
                 in.commanded_acceleration_m_s2, in.force_N[0] - in.force_N[1], surprise},
                log_sigma0);
}

template <class Core>
StateMask<kSevenStates> SevenStateFilter<Core>::Adapted(bool at_rest) const noexcept {
  auto mask = AllStates<kSevenStates>();
  const auto& x = core_.x;
  const bool moving = !at_rest && adapts();
  const bool forward = x[kVelocity] >= 0.0;
  mask[kLevelPlus] = moving && forward;
  mask[kLevelMinus] = moving && !forward;
  mask[kLogSigma0] = moving && evidence_.shows();
  return mask;
}

template <class Core>
UpdateResult SevenStateFilter<Core>::MeasurementUpdate(const AxisEstimatorInput& in,
                                                       Innovation& innovation) noexcept {
  auto& x = core_.x;
  const double y = in.position_m - WindUpShare_m(Total_N(x, at_), x[kDisturbance], lag_.force_N());
  const Friction& f = setup_.friction;
  const double least_plus_N = std::min(kLeastLeft * x[kLevelPlus], kLeastByReading * f.Fc_plus_N);
  const double least_minus_N = std::min(kLeastLeft * x[kLevelMinus], kLeastByReading * f.Fc_minus_N);
  const double log_sigma0 = x[kLogSigma0];
  gate_.Expect(setup_.Sudden_m(in.force_N[1], in.force_N[2]));
  const UpdateResult result =
      core_.UpdateState0(y, setup_.measurement_std_m, gate_.gate(), Adapted(in.at_rest), innovation);
  const double off = std::abs(innovation.value), most = kMostInfluence * innovation.std;
  if (off > most) x[kLogSigma0] = log_sigma0 + most / off * (x[kLogSigma0] - log_sigma0);
  gate_.After(innovation.value, innovation.std);
  x[kLevelPlus] = std::max(x[kLevelPlus], least_plus_N);
  x[kLevelMinus] = std::max(x[kLevelMinus], least_minus_N);
  at_ = model_.TermsAt(x[kVelocity]);
  return result;
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

// The covariance says what noise does. Innovations larger than it expects (a wrong model) widen the band in
// proportion, smaller ones narrow it: process noise is stated for what an axis does at its worst, and a wrong
// mass is seen by nothing but the acceleration it is multiplied with.
template <class Core>
double SevenStateFilter<Core>::FrictionStd_N(double acceleration_m_s2) const noexcept {
  const double filter_N =
      core_.Std({0.0, model_.sigma2_Ns_m(), 1.0, 1.0, 0.0, 0.0, 0.0}, kVelocity, kLevelPlus);
  const double mass_N = setup_.config.mass_std * setup_.mechanics.mass_kg * acceleration_m_s2;
  return std::sqrt(std::max(kLeastSurprise, surprise_) * filter_N * filter_N + mass_N * mass_N);
}

template <class Core>
AxisEstimate SevenStateFilter<Core>::Update(const AxisEstimatorInput& in) noexcept {
  AxisEstimate out;
  at_rest_ = in.at_rest;
  periods_since_position_ += 1.0;
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
        surprise_ += surprise_share_ * (ratio * ratio - surprise_);
      }
      if (result == UpdateResult::kGated) out.limit = Reason::kInnovationGated;
      if (gated_in_a_row_ != 0 && StartsAgain(gated_in_a_row_, setup_.period_s)) Follow(in.position_m);
    }
    out.innovation_m = innovation.value;
    out.innovation_std_m = innovation.std;
    JudgeLevel(in.at_rest);
    JudgeStiffness(in, innovation.std > 0.0 ? innovation.value / innovation.std : 0.0);
    const bool bounded = Bound();
    if (!in.at_rest && adapts()) JudgeOutsideForce();
    if (bounded && out.limit == Reason::kNone) out.limit = Reason::kParameterBound;
  }
  if (in.fresh) {
    last_position_m_ = in.position_m;
    periods_since_position_ = 0.0;
  }
  const auto& x = core_.x;
  sigma0_N_m_ = model_.Sigma0_N_m(x);
  LookAhead(in);

  const double friction_N = Total_N(x, at_);
  const double ahead_N = Total_N(predicted_, model_.TermsAt(predicted_[kVelocity]));
  out.position_m = x[kPosition] + WindUpShare_m(friction_N, x[kDisturbance], lag_.force_N());
  out.velocity_m_s = x[kVelocity];
  out.predicted_position_m =
      predicted_[kPosition] + WindUpShare_m(ahead_N, predicted_[kDisturbance], in.force_N[0]);
  out.predicted_velocity_m_s = predicted_[kVelocity];
  out.bristle_N = x[kBristle];
  out.disturbance_N = x[kDisturbance];
  out.friction_N = friction_N;
  out.friction_std_N = FrictionStd_N(in.commanded_acceleration_m_s2);
  out.g_plus_N = x[kLevelPlus];
  out.g_minus_N = x[kLevelMinus];
  out.sigma0_N_m = sigma0_N_m_;
  out.diverged = !square_root::Sound(core_.x, core_.s, std_limit_);
  return out;
}

template class SevenStateFilter<SqrtUkf<kSevenStates>>;
template class SevenStateFilter<SqrtEkf<kSevenStates>>;

}  // namespace contour
