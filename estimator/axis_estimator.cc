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

AxisEstimator::AxisEstimator(EstimatorKind kind, const Mechanics& mechanics, const FrictionConfig& friction,
                             const EstimatorConfig& config, double period_s, double lag_s,
                             double resolution_m, KnownEffects known)
    : kind_(kind), known_(std::move(known)) {
  const FilterSetup setup = Check(mechanics, friction, config, period_s, lag_s, resolution_m);
  switch (kind) {
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
      filter_.emplace<SevenStateFilter<SqrtUkf<kSevenStates>>>(setup);
      break;
  }
  roll_ = FrictionRoll(period_s);
  rigid_ = RigidCorrection({mechanics.mass_kg, setup.friction.sigma2_Ns_m,
                            config.adapt ? config.mass_rate : 0.0, config.adapt ? config.viscous_rate : 0.0});
  correction_ =
      LevelCorrection({2.0 * std::numbers::pi * mechanics.radius_m_rad, setup.friction.vs_m_s,
                       config.adapt ? config.ripple_rate : 0.0, config.adapt ? config.stribeck_rate : 0.0});
}

void AxisEstimator::Reset(double position_m) noexcept {
  WithFilter(filter_, [&](auto& filter) noexcept { filter.Reset(position_m); });
  roll_.Reset(0.0);
  correction_.Reset();
  rigid_.Reset();
  at_rest_ = true;
}

AxisEstimate AxisEstimator::Update(const Input& in) noexcept {
  at_rest_ = in.at_rest || !in.enabled;
  if (kind_ == EstimatorKind::kFull) return UpdateFull(in);
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
  filter.SetKnownForces_N(rigid_.extra_kg() * in.commanded_acceleration_m_s2,
                          rigid_.extra_Ns_m() * in.commanded_velocity_m_s +
                              known_.Viscous_N(in.commanded_velocity_m_s, temperature_degC_));
  // In the middle of the period that has passed, and of the one that lies ahead. ahead is t(k-1) here.
  const double next_m = ahead[kPosition] + ahead[kVelocity] * roll_.period_s();
  filter.SetDrivingForces_N(known_.Force_N(0.5 * (filter.state()[kPosition] + ahead[kPosition])),
                            known_.Force_N(0.5 * (ahead[kPosition] + next_m)));
  return filter.Update(in);
}

void AxisEstimator::PreviewFriction(const AxisHorizon& reference, std::size_t points,
                                    FrictionPreview& out) noexcept {
  if (kind_ == EstimatorKind::kFull) {
    const auto& filter = *std::get_if<SevenStateFilter<SqrtUkf<kSevenStates>>>(&filter_);
    roll_.Run(filter.model(), filter.state(), correction_, rigid_, {known_, temperature_degC_}, at_rest_,
              reference, points, out);
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
