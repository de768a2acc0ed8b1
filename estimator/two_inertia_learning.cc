// What TwoInertiaEstimator learns, and how far it is from what it believes.

#include <algorithm>
#include <cmath>

#include "estimator/two_inertia_estimator.h"

namespace contour {
namespace {

using namespace friction_term;  // NOLINT(google-build-using-namespace): names of terms only

// Of kInertialPart, what is left in torque mode, where what a period gave is known and the mass is learnt.
constexpr double kInertialByCommand = 0.2;
// A force that goes on changing is off by more than it changes by until half of it shows: in variances.
constexpr double kLateByMore = 2.0;
// A change of this moment counts as far as it is more than noise makes of it in 19 of 20 samples; in
// variances of the noise, which a difference has twice.
constexpr double kNoiseOfChange = 2.0 * 4.0;

// Of the level, as a standard deviation: three of them to either side, and as much again by bristles that
// answer what the target does, stay below a tenth of what friction winds the screw up by.
constexpr double kNoAccount = 0.01;

}  // namespace

void TwoInertiaEstimator::Learn(const AxisEstimatorInput& in, bool may) noexcept {
  const std::size_t period = elapsed_;
  if (along_.size() == 0) return;
  const double velocity_m_s = 0.5 * (along_.velocity_m_s(period) + along_.velocity_m_s(period + 1));
  at_rest_ = in.at_rest && velocity_m_s == 0.0;
  FrictionTerms terms;
  for (std::size_t i = 0; i < kFrictionTerms; ++i)
    terms[i] = 0.5 * (along_.terms(period)[i] + along_.terms(period + 1)[i]);
  const double used_N = 0.5 * (At(period).learnt_N + At(period + 1).learnt_N);
  unexplained_N_ = learner_.Learn(terms, used_N, observer_.disturbance_N(), std::abs(velocity_m_s),
                                  may && !at_rest_, reports_are_noise_ ? noise_N2_ : 0.0);
  if (!at_rest_) band_.Step(unexplained_N_);
  Doubt(terms[kMass]);
  if (at_rest_)
    Rest();
  else
    resting_.Move();
  if (may && !at_rest_)
    LearnMotor(in.position_m);
  else
    balance_.Pause();
  if (may && !at_rest_ && !scale_)
    LearnWindUp(in);
  else
    wind_up_.Pause();
}

// What the axis was driven with beyond all that is known and expected belongs to the screw's angle if it
// comes again there.
void TwoInertiaEstimator::LearnMotor(double position_m) noexcept {
  const Node& here = At(elapsed_);
  const Node& next = At(elapsed_ + 1);
  const double against_N = 0.5 * (here.friction_N + next.friction_N + here.heavier_N + next.heavier_N -
                                  here.driving_N - next.driving_N - here.pulling_N - next.pulling_N +
                                  setup_.friction.sigma2_Ns_m *
                                      (along_.velocity_m_s(elapsed_) + along_.velocity_m_s(elapsed_ + 1)));
  balance_.Learn(position_m, acted_N_, against_N);
  if (const MomentumBalance::Missing& m = balance_.missing(); m.known)
    map_.Learn(m.position_m, m.velocity_m_s, m.acceleration_m_s2, m.force_N);
}

// Noise hangs together over about the time in which the observer sees a force, and a mean has the less of it
// the longer it is beyond that.
double TwoInertiaEstimator::NoiseTakes_s() const noexcept {
  const double no_account_N = kNoAccount * along_.basis().scale().level_N;
  return static_cast<double>(settle_) * setup_.period_s * noise_N2_ / (no_account_N * no_account_N);
}

void TwoInertiaEstimator::Rest() noexcept {
  learner_.Rest();
  if (frozen_ || !along_.Still()) return;
  along_.Relax(resting_.Step(along_.Carried_N(learner_.parameters()), unexplained_N_, NoiseTakes_s()));
}

// As far as it is stated, or known by now; but no better than what is never told from friction.
double TwoInertiaEstimator::MassStd_kg() const noexcept {
  const double mass_kg = setup_.mechanics.mass_kg;
  const double least_kg = kInertialPart * (setup_.reported_torque ? 1.0 : kInertialByCommand) * mass_kg;
  return std::max(least_kg, std::min(setup_.config.mass_std * mass_kg, std::sqrt(learner_.variance(kMass))));
}

// What the force has changed by since the observer could see it is what is off in between: on average, and at
// this moment. Noise of single samples is in a difference of two of them twice; a second difference, which a
// force that goes on changing hardly has, has six times its variance. And what accelerates the axis is off.
void TwoInertiaEstimator::Doubt(double acceleration_m_s2) noexcept {
  newest_ = (newest_ + 1) % found_N_.size();
  found_N_[newest_] = unexplained_N_;
  const auto before_N = [this](std::size_t periods) {
    return found_N_[(newest_ + found_N_.size() - periods) % found_N_.size()];
  };
  const double change_N = unexplained_N_ - before_N(settle_);
  const double bend_N = change_N - before_N(settle_) + before_N(2 * settle_);
  surprise_N2_ += surprise_share_ * (change_N * change_N - surprise_N2_);
  noise_N2_ += surprise_share_ * (bend_N * bend_N / 6.0 - noise_N2_);
  const double last_N2 = std::max(0.0, change_N * change_N - kNoiseOfChange * noise_N2_);
  const double inertial_N = MassStd_kg() * acceleration_m_s2;
  const double late_N2 = kLateByMore * std::max(0.0, surprise_N2_ - 2.0 * noise_N2_);
  variance_N2_ = late_N2 + noise_N2_ + last_N2 + inertial_N * inertial_N;
}

void TwoInertiaEstimator::LearnWindUp(const AxisEstimatorInput& in) noexcept {
  if (!wind_up_.learns()) return;
  WindUpFit::Sample sample;
  const double velocity_m_s = along_.velocity_m_s(elapsed_ + 1);
  sample.alone = in.alone;
  sample.position_m = in.position_m;
  sample.force_N = acted_N_ + At(elapsed_).driving_N + At(elapsed_).pulling_N - learner_.Weight_N();
  sample.mass_kg = setup_.mechanics.mass_kg + learner_.parameters()[kMass];
  sample.direction = velocity_m_s > 0.0 ? 1 : velocity_m_s < 0.0 ? -1 : 0;
  if (wind_up_.NeedsLevels(sample.direction)) {
    const bool forward = velocity_m_s >= 0.0;
    sample.level_N = learner_.SlidingLevel_N(forward, 0.0);
    sample.level_ratio = learner_.SlidingLevel_N(forward, std::abs(velocity_m_s)) / sample.level_N;
    sample.sigma0_N_m = setup_.friction.sigma0_N_m;
  }
  wind_up_.Learn(sample);
}

}  // namespace contour
