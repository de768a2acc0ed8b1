#include "estimator/full_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/wide_vectors.h"

namespace contour {
namespace {

/// A planned motion slower than this has come to its end.
constexpr double kStill_m_s = 1e-6;

}  // namespace

FullEstimator::FullEstimator(const FilterSetup& setup, KnownEffects known)
    : filter_(setup),
      roll_(setup.period_s, setup.reported_torque),
      learnt_(setup),
      lag_(setup.period_s, setup.lag_s),
      mass_kg_(setup.mechanics.mass_kg),
      table_mass_kg_(setup.mechanics.table_mass_kg),
      before_screw_(setup.friction.motor_share),
      stiffness_std_(setup.config.stiffness_std),
      known_(std::move(known)) {}

void FullEstimator::Reset(double position_m) noexcept {
  const double table_N = known_.TableForce_N(position_m);
  filter_.SetTableForces_N(table_N, table_N);
  filter_.Reset(position_m);
  roll_.Reset(0.0);
  learnt_.Reset();
  drive_N_ = 0.0;
  lag_.Reset();
  at_rest_ = true;
  knows_followed_ = false;
}

void FullEstimator::Freeze(bool frozen) noexcept {
  if (frozen == frozen_) return;
  frozen_ = frozen;
  filter_.Freeze(frozen);
}

// The motion is the one that is followed, and force acts as late as was learnt.
AxisEstimatorInput FullEstimator::Followed(const AxisEstimatorInput& in) noexcept {
  AxisEstimatorInput followed = in;
  if (knows_followed_) {
    followed.commanded_velocity_m_s = followed_.velocity_m_s;
    followed.commanded_acceleration_m_s2 = followed_.acceleration_m_s2;
    // A planned corner goes on after the program's own motion of the axis has come to its end.
    followed.at_rest = in.at_rest && std::abs(followed_.velocity_m_s) < kStill_m_s;
    knows_followed_ = false;
  }
  const double late = learnt_.momentum.delay_periods();
  for (std::size_t i = 0; i + 1 < followed.force_N.size(); ++i)
    followed.force_N[i] += late * (in.force_N[i + 1] - in.force_N[i]);
  return followed;
}

double FullEstimator::Driving_N(double position_m, double velocity_m_s) const noexcept {
  const double known_N = known_.neutral() ? 0.0 : known_.Force_N(position_m);
  return known_N + learnt_.map.At_N(position_m, velocity_m_s);
}

void FullEstimator::TellKnownForces(const AxisEstimatorInput& followed) noexcept {
  const auto& ahead = filter_.predicted();
  filter_.SetKnownForces_N(learnt_.momentum.extra_kg() * followed.commanded_acceleration_m_s2,
                           learnt_.viscous.extra_Ns_m() * followed.commanded_velocity_m_s +
                               known_.Viscous_N(followed.commanded_velocity_m_s, temperature_degC_),
                           learnt_.momentum.mass_variance_left());
  // In the middle of the period that has passed, and of the one that lies ahead. ahead is t(k-1) here.
  const double next_m = ahead[kPosition] + ahead[kVelocity] * roll_.period_s();
  filter_.SetDrivingForces_N(
      Driving_N(0.5 * (filter_.state()[kPosition] + ahead[kPosition]), ahead[kVelocity]),
      Driving_N(0.5 * (ahead[kPosition] + next_m), ahead[kVelocity]));
  if (!known_.neutral())
    filter_.SetTableForces_N(known_.TableForce_N(ahead[kPosition]), known_.TableForce_N(next_m));
}

CONTOUR_WIDE_VECTORS
AxisEstimate FullEstimator::Update(const AxisEstimatorInput& in) noexcept {
  const auto& ahead = filter_.predicted();
  const auto basis = learnt_.level.Basis(ahead[kPosition], ahead[kVelocity]);
  const double level = known_.LevelFactor(ahead[kPosition]);
  filter_.SetLevelFactors(level * learnt_.level.Factor(basis, true),
                          level * learnt_.level.Factor(basis, false));
  temperature_degC_ = in.temperature_degC;
  const AxisEstimatorInput followed = Followed(in);
  at_rest_ = followed.at_rest || !in.enabled;
  TellKnownForces(followed);
  AxisEstimate estimate = filter_.Update(followed);
  // Over the period that ends with this measurement.
  const double force_N = lag_.Step(in.force_N[1])[0];
  if (in.enabled && in.fresh && !frozen_ && !followed.at_rest && estimate.limit != Reason::kInnovationGated)
    Learn(followed, force_N, estimate);
  else
    learnt_.Pause();
  drive_N_ = force_N;
  const ScrewStiffness stiffness = StiffnessBy(learnt_.wind_up, before_screw_, stiffness_std_);
  estimate.stiffness_N_m = stiffness.N_m;
  estimate.stiffness_std_N_m = stiffness.std_N_m;
  return estimate;
}

void FullEstimator::Learn(const AxisEstimatorInput& followed, double force_N,
                          const AxisEstimate& estimate) noexcept {
  const double late = learnt_.momentum.delay_periods();
  learnt_.momentum.Learn(followed.position_m, force_N, roll_.rolled_N());
  if (const auto& m = learnt_.momentum.missing(); m.known)
    learnt_.map.Learn(m.position_m, m.velocity_m_s, m.acceleration_m_s2, m.force_N);
  const double acted_N =
      force_N + late * (drive_N_ - force_N) +
      Driving_N(filter_.state()[kPosition] - 0.5 * filter_.state()[kVelocity] * roll_.period_s(),
                filter_.predicted()[kVelocity]);
  LearnWindUp(followed, acted_N, estimate);
}

void FullEstimator::LearnWindUp(const AxisEstimatorInput& followed, double force_N,
                                const AxisEstimate& estimate) noexcept {
  if (!learnt_.wind_up.learns()) return;
  const double velocity_m_s = followed.commanded_velocity_m_s;
  WindUpFit::Sample sample;
  sample.alone = followed.alone;
  sample.position_m = followed.position_m;
  sample.force_N = force_N;
  sample.mass_kg = mass_kg_ + learnt_.momentum.extra_kg();
  sample.direction = velocity_m_s > 0.0 ? 1 : velocity_m_s < 0.0 ? -1 : 0;
  if (learnt_.wind_up.NeedsLevels(sample.direction)) {
    StateVector<kSevenStates> x{};
    x[kLevelPlus] = estimate.g_plus_N;
    x[kLevelMinus] = estimate.g_minus_N;
    auto basis = learnt_.level.RippleBasis(sample.position_m);
    const auto level_N = [&](double at_m_s) {
      basis[LevelCorrection::kRippleTerms] = ExpOfNegative(learnt_.level.LowSpeedExponent(at_m_s));
      x[kVelocity] = at_m_s;
      return filter_.model().Level(
                 x, filter_.model().TermsAt(at_m_s),
                 {{}, learnt_.level.Factor(basis, true), learnt_.level.Factor(basis, false)}) *
             known_.LevelFactor(sample.position_m);
    };
    sample.level_N = level_N(std::copysign(kStill_m_s, velocity_m_s));
    sample.level_ratio = level_N(velocity_m_s) / sample.level_N;
    sample.sigma0_N_m = estimate.sigma0_N_m;
  }
  learnt_.wind_up.Learn(sample);
}

void FullEstimator::PreviewFriction(const AxisHorizon& reference, std::size_t points,
                                    FrictionPreview& out) noexcept {
  const KnownNow known{known_,
                       temperature_degC_,
                       learnt_.map,
                       learnt_.momentum.extra_kg(),
                       filter_.lasting_N(),
                       filter_.sigma0_N_m(),
                       !frozen_};
  roll_.Run(filter_.model(), filter_.state(), learnt_.level, learnt_.viscous, known, at_rest_, reference,
            points, out);
  // The commissioned compliance is made up for where the reference is; what has been learnt of it, here.
  const double extra_m_N = learnt_.wind_up.extra_compliance_m_N() / (1.0 - before_screw_);
  if (before_screw_ != 0.0)
    for (FrictionAhead& f : out) f.node_N -= before_screw_ * f.node_N;
  if (!known_.neutral())
    for (std::size_t j = 0; j < out.size(); ++j)
      out[j].node_N -= known_.TableForce_N(reference[j].position_m);
  if (extra_m_N != 0.0)
    for (std::size_t j = 0; j < out.size(); ++j)
      out[j].lead_m += extra_m_N * (out[j].node_N + table_mass_kg_ * reference[j].acceleration_m_s2);
  knows_followed_ = reference.size() > 1;
  if (knows_followed_) followed_ = reference[1];
}

}  // namespace contour
