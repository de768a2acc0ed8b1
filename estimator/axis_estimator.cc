#include "estimator/axis_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace contour {
namespace {

/// A planned motion slower than this has come to its end.
constexpr double kStill_m_s = 1e-6;
/// Reported torque is coarser than commanded torque is known: each reversal tells less of the screw, and all
/// of them together are farther off.
constexpr double kMostStdInCascade = 0.25;
constexpr double kSameLawInCascade = 0.3;

void Demand(bool ok, const char* what) {
  if (!ok) throw std::invalid_argument(std::string("estimator: ") + what);
}

bool Positive(double x) { return std::isfinite(x) && x > 0.0; }
bool NotNegative(double x) { return std::isfinite(x) && x >= 0.0; }

FilterSetup Check(const Mechanics& mechanics, const FrictionConfig& config_friction,
                  const EstimatorConfig& config, double period_s, double lag_s, double resolution_m) {
  Demand(Positive(period_s), "the cycle period must be positive");
  Demand(NotNegative(lag_s), "the drive's lag must not be negative");
  Demand(NotNegative(resolution_m), "the encoder's resolution must not be negative");
  Demand(Positive(mechanics.radius_m_rad), "the screw's lead must be positive");
  Demand(Positive(mechanics.mass_kg) && NotNegative(mechanics.table_mass_kg), "masses must be positive");
  Demand(mechanics.table_mass_kg <= mechanics.mass_kg, "the table cannot be heavier than the whole axis");
  Demand(Positive(mechanics.stiffness_N_m), "the screw's stiffness must be positive");
  const Friction f = ToSi(config_friction, mechanics.radius_m_rad);
  Demand(Positive(f.Fs_plus_N) && Positive(f.Fs_minus_N) && Positive(f.Fc_plus_N) && Positive(f.Fc_minus_N),
         "friction levels must be positive");
  Demand(Positive(f.vs_m_s) && Positive(f.stribeck_exponent), "the Stribeck velocity must be positive");
  Demand(Positive(f.sigma0_N_m), "sigma0 must be positive");
  Demand(NotNegative(f.sigma1_Ns_m) && Positive(f.sigma1_decay_m_s), "sigma1 must not be negative");
  Demand(NotNegative(f.sigma2_Ns_m), "sigma2 must not be negative");
  Demand(Positive(config.measurement_noise_um), "the measurement noise must be positive");
  // A rounded position is off by at most half a count, uniformly: LSB / sqrt(12).
  const double rounding_m = resolution_m / std::sqrt(12.0);
  return {mechanics, f, config, period_s, lag_s, std::max(config.measurement_noise_um * 1e-6, rounding_m)};
}

/// Calls `what` with the filter that is there. std::visit does the same but may throw, which the cycle
/// cannot.
template <class Filters, class What>
void WithFilter(Filters& filters, What&& what) noexcept {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto one = [&](auto* filter) {
      if (filter != nullptr) what(*filter);
    };
    (one(std::get_if<I>(&filters)), ...);
  }
  (std::make_index_sequence<std::variant_size_v<std::remove_const_t<Filters>>>{});
}

}  // namespace

FilterSetup AxisEstimator::SetupOf(const Mechanics& mechanics, const FrictionConfig& friction,
                                   const EstimatorConfig& config, double period_s, double lag_s,
                                   double resolution_m) {
  return Check(mechanics, friction, config, period_s, lag_s, resolution_m);
}

AxisEstimator::AxisEstimator(const TwoInertiaEstimator::Setup& setup)
    : kind_(EstimatorKind::kTwoInertia),
      filter_(KinematicObserver(setup.filter)),
      two_inertia_(std::make_unique<TwoInertiaEstimator>(setup)) {}

AxisEstimator::AxisEstimator(EstimatorKind kind, const Mechanics& mechanics, const FrictionConfig& friction,
                             const EstimatorConfig& config, double period_s, double lag_s,
                             double resolution_m, KnownEffects known)
    : kind_(kind), known_(std::move(known)) {
  const bool cascade = kind == EstimatorKind::kFullInCascade;
  // The torque that a drive reports is what it gives: its lag is behind it.
  if (cascade) lag_s = 0.0;
  FilterSetup setup = SetupOf(mechanics, friction, config, period_s, lag_s, resolution_m);
  setup.reported_torque = cascade;
  setup.looks_ahead = !is_full();
  switch (kind) {
    case EstimatorKind::kTwoInertia:
      throw std::invalid_argument("estimator: two inertias have a setup of their own");
    case EstimatorKind::kKinematic:
      filter_.emplace<KinematicObserver>(setup);
      break;
    case EstimatorKind::kDisturbanceObserver:
      filter_.emplace<DisturbanceObserver>(setup);
      break;
    case EstimatorKind::kSrukf4:
      filter_.emplace<FourStateFilter>(setup);
      break;
    case EstimatorKind::kEkf7:
      filter_.emplace<SevenStateFilter<SqrtEkf<kSevenStates>>>(setup);
      break;
    case EstimatorKind::kSrukf7:
    case EstimatorKind::kFull:
    case EstimatorKind::kFullInCascade:
      filter_.emplace<SevenStateFilter<SqrtUkf<kSevenStates>>>(setup);
      break;
  }
  roll_ = FrictionRoll(period_s, cascade);
  viscous_ =
      ViscousCorrection({setup.friction.sigma2_Ns_m, config.adapt ? config.viscous_rate : 0.0, period_s});
  momentum_ = MomentumBalance({mechanics.mass_kg, period_s, config.adapt ? config.mass_rate : 0.0,
                               config.adapt ? config.delay_rate : 0.0});
  lag_ = DriveLag<1>(period_s, lag_s);
  // A second difference of the position takes sqrt(1 + 4 + 1) of its noise.
  const double difference_N =
      std::sqrt(6.0) * setup.measurement_std_m * mechanics.mass_kg / (period_s * period_s);
  map_ = AngleForceMap({2.0 * std::numbers::pi * mechanics.radius_m_rad, difference_N,
                        config.adapt ? config.cogging_rate : 0.0, period_s});
  WindUpFit::Tuning screw;
  screw.period_s = period_s;
  screw.stiffness_N_m = mechanics.stiffness_N_m;
  screw.stiffness_std = config.adapt ? config.stiffness_std : 0.0;
  screw.vs_m_s = setup.friction.vs_m_s;
  screw.sigma1_Ns_m = setup.friction.sigma1_Ns_m;
  screw.sigma1_decay_m_s = setup.friction.sigma1_decay_m_s;
  screw.sigma2_Ns_m = setup.friction.sigma2_Ns_m;
  if (cascade) {
    screw.most_std = kMostStdInCascade;
    screw.same_law = kSameLawInCascade;
  }
  wind_up_ = WindUpFit(screw);
  mass_kg_ = mechanics.mass_kg;
  table_mass_kg_ = mechanics.table_mass_kg;
  correction_ = LevelCorrection({2.0 * std::numbers::pi * mechanics.radius_m_rad, setup.friction.vs_m_s,
                                 config.adapt ? config.ripple_rate : 0.0,
                                 config.adapt ? config.stribeck_rate : 0.0, period_s});
}

void AxisEstimator::Reset(double position_m) noexcept {
  if (two_inertia_) return two_inertia_->Reset(position_m);
  WithFilter(filter_, [&](auto& filter) noexcept { filter.Reset(position_m); });
  roll_.Reset(0.0);
  correction_.Reset();
  viscous_.Reset();
  momentum_.Reset();
  map_.Reset();
  wind_up_.Reset();
  drive_N_ = 0.0;
  lag_.Reset();
  at_rest_ = true;
  knows_followed_ = false;
}

void AxisEstimator::Freeze(bool frozen) noexcept {
  if (two_inertia_) return two_inertia_->Freeze(frozen);
  if (frozen == frozen_) return;
  frozen_ = frozen;
  WithFilter(filter_, [&](auto& filter) noexcept {
    if constexpr (requires { filter.Freeze(frozen); }) filter.Freeze(frozen);
  });
}

AxisEstimate AxisEstimator::Update(const Input& in) noexcept {
  if (two_inertia_) return two_inertia_->Update(in);
  if (is_full()) return UpdateFull(in);
  at_rest_ = in.at_rest || !in.enabled;
  AxisEstimate estimate;
  WithFilter(filter_, [&](auto& filter) noexcept { estimate = filter.Update(in); });
  return estimate;
}

AxisEstimate AxisEstimator::UpdateFull(const Input& in) noexcept {
  auto& filter = *std::get_if<SevenStateFilter<SqrtUkf<kSevenStates>>>(&filter_);
  const auto& ahead = filter.predicted();
  const auto basis = correction_.Basis(ahead[kPosition], ahead[kVelocity]);
  const double level = known_.LevelFactor(ahead[kPosition]);
  filter.SetLevelFactors(level * correction_.Factor(basis, true), level * correction_.Factor(basis, false));
  temperature_degC_ = in.temperature_degC;
  Input followed = in;
  if (knows_followed_) {
    followed.commanded_velocity_m_s = followed_.velocity_m_s;
    followed.commanded_acceleration_m_s2 = followed_.acceleration_m_s2;
    // A planned corner goes on after the program's own motion of the axis has come to its end.
    followed.at_rest = in.at_rest && std::abs(followed_.velocity_m_s) < kStill_m_s;
    knows_followed_ = false;
  }
  at_rest_ = followed.at_rest || !in.enabled;
  const double late = momentum_.delay_periods();
  for (std::size_t i = 0; i + 1 < followed.force_N.size(); ++i)
    followed.force_N[i] += late * (in.force_N[i + 1] - in.force_N[i]);
  filter.SetKnownForces_N(momentum_.extra_kg() * followed.commanded_acceleration_m_s2,
                          viscous_.extra_Ns_m() * followed.commanded_velocity_m_s +
                              known_.Viscous_N(followed.commanded_velocity_m_s, temperature_degC_));
  // In the middle of the period that has passed, and of the one that lies ahead. ahead is t(k-1) here.
  const double next_m = ahead[kPosition] + ahead[kVelocity] * roll_.period_s();
  const auto driving_N = [&](double position_m) {
    return known_.Force_N(position_m) + map_.At_N(position_m, ahead[kVelocity]);
  };
  filter.SetDrivingForces_N(driving_N(0.5 * (filter.state()[kPosition] + ahead[kPosition])),
                            driving_N(0.5 * (ahead[kPosition] + next_m)));
  const AxisEstimate estimate = filter.Update(followed);
  // Over the period that ends with this measurement.
  const double force_N = lag_.Step(in.force_N[1])[0];
  if (in.enabled && in.fresh && !frozen_ && !followed.at_rest && estimate.limit != Reason::kInnovationGated) {
    momentum_.Learn(in.position_m, force_N, roll_.rolled_N());
    if (const auto& m = momentum_.missing(); m.known)
      map_.Learn(m.position_m, m.velocity_m_s, m.acceleration_m_s2, m.force_N);
    const double acted_N =
        force_N + late * (drive_N_ - force_N) +
        driving_N(filter.state()[kPosition] - 0.5 * filter.state()[kVelocity] * roll_.period_s());
    LearnWindUp(in.position_m, followed.commanded_velocity_m_s, acted_N, in.alone, estimate);
  } else {
    momentum_.Pause();
    wind_up_.Pause();
  }
  drive_N_ = force_N;
  return estimate;
}

void AxisEstimator::LearnWindUp(double position_m, double velocity_m_s, double force_N, bool alone,
                                const AxisEstimate& estimate) noexcept {
  if (!wind_up_.learns()) return;
  WindUpFit::Sample sample;
  sample.alone = alone;
  sample.position_m = position_m;
  sample.force_N = force_N;
  sample.mass_kg = mass_kg_ + momentum_.extra_kg();
  sample.direction = velocity_m_s > 0.0 ? 1 : velocity_m_s < 0.0 ? -1 : 0;
  if (wind_up_.NeedsLevels(sample.direction)) {
    const auto& model = std::get_if<SevenStateFilter<SqrtUkf<kSevenStates>>>(&filter_)->model();
    StateVector<kSevenStates> x{};
    x[kLevelPlus] = estimate.g_plus_N;
    x[kLevelMinus] = estimate.g_minus_N;
    const auto level_N = [&](double at_m_s) {
      const auto basis = correction_.Basis(position_m, at_m_s);
      x[kVelocity] = at_m_s;
      return model.Level(x, model.TermsAt(at_m_s),
                         {{}, correction_.Factor(basis, true), correction_.Factor(basis, false)}) *
             known_.LevelFactor(position_m);
    };
    sample.level_N = level_N(std::copysign(kStill_m_s, velocity_m_s));
    sample.level_ratio = level_N(velocity_m_s) / sample.level_N;
    sample.sigma0_N_m = estimate.sigma0_N_m;
  }
  wind_up_.Learn(sample);
}

void AxisEstimator::PreviewFriction(const AxisHorizon& reference, std::size_t points,
                                    FrictionPreview& out) noexcept {
  if (two_inertia_) return two_inertia_->PreviewFriction(reference, points, out);
  if (is_full()) {
    const auto& filter = *std::get_if<SevenStateFilter<SqrtUkf<kSevenStates>>>(&filter_);
    roll_.Run(filter.model(), filter.state(), correction_, viscous_,
              {known_, temperature_degC_, map_, momentum_.extra_kg(), filter.lasting_N(), !frozen_}, at_rest_,
              reference, points, out);
    // The commissioned compliance is made up for where the reference is; what has been learnt of it, here.
    const double extra_m_N = wind_up_.extra_compliance_m_N();
    for (std::size_t j = 0; j < out.size(); ++j)
      out[j].lead_m += extra_m_N * (out[j].node_N + table_mass_kg_ * reference[j].acceleration_m_s2);
    knows_followed_ = reference.size() > 1;
    if (knows_followed_) followed_ = reference[1];
    return;
  }
  double ahead_N = 0.0;
  WithFilter(filter_, [&](const auto& filter) noexcept {
    if constexpr (requires { filter.FrictionAhead_N(); }) ahead_N = filter.FrictionAhead_N();
  });
  out.resize(std::min(points, reference.size()));
  for (auto& f : out) f = {ahead_N, ahead_N, 0.0};
}

}  // namespace contour
