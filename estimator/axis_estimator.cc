#include "estimator/axis_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
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
  FilterSetup setup{mechanics, f, config, period_s, lag_s};
  setup.measurement_std_m = std::max(config.measurement_noise_um * 1e-6, rounding_m);
  setup.encoder_step_m = resolution_m;
  return setup;
}

/// Calls `what` with the one that is there. std::visit does the same but may throw, which the cycle cannot.
template <class Kinds, class What>
void WithOne(Kinds& kinds, What&& what) noexcept {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto call = [&](auto* one) {
      if (one != nullptr) what(*one);
    };
    (call(std::get_if<I>(&kinds)), ...);
  }
  (std::make_index_sequence<std::variant_size_v<std::remove_const_t<Kinds>>>{});
}

}  // namespace

FilterSetup AxisEstimator::SetupOf(const Mechanics& mechanics, const FrictionConfig& friction,
                                   const EstimatorConfig& config, double period_s, double lag_s,
                                   double resolution_m) {
  return Check(mechanics, friction, config, period_s, lag_s, resolution_m);
}

AxisEstimator::AxisEstimator(const TwoInertiaEstimator::Setup& setup)
    : one_(std::in_place_type<TwoInertiaEstimator>, setup) {}

AxisEstimator::AxisEstimator(EstimatorKind kind, const Mechanics& mechanics, const FrictionConfig& friction,
                             const EstimatorConfig& config, double period_s, double lag_s,
                             double resolution_m, KnownEffects known) {
  const bool cascade = kind == EstimatorKind::kFullInCascade;
  // The torque that a drive reports is what it gives: its lag is behind it.
  if (cascade) lag_s = 0.0;
  FilterSetup setup = SetupOf(mechanics, friction, config, period_s, lag_s, resolution_m);
  setup.reported_torque = cascade;
  switch (kind) {
    case EstimatorKind::kTwoInertia:
      throw std::invalid_argument("estimator: two inertias have a setup of their own");
    case EstimatorKind::kKinematic:
      one_.emplace<KinematicObserver>(setup);
      break;
    case EstimatorKind::kDisturbanceObserver:
      one_.emplace<DisturbanceObserver>(setup);
      break;
    case EstimatorKind::kSrukf4:
      one_.emplace<FourStateFilter>(setup);
      break;
    case EstimatorKind::kEkf7:
      one_.emplace<SevenStateFilter<SqrtEkf<kSevenStates>>>(setup);
      break;
    case EstimatorKind::kSrukf7:
      one_.emplace<SevenStateFilter<SqrtUkf<kSevenStates>>>(setup);
      break;
    case EstimatorKind::kFull:
    case EstimatorKind::kFullInCascade:
      setup.looks_ahead = false;
      one_.emplace<FullEstimator>(setup, std::move(known));
      break;
  }
}

void AxisEstimator::Reset(double position_m) noexcept {
  WithOne(one_, [&](auto& one) noexcept { one.Reset(position_m); });
}

void AxisEstimator::Freeze(bool frozen) noexcept {
  WithOne(one_, [&](auto& one) noexcept {
    if constexpr (requires { one.Freeze(frozen); }) one.Freeze(frozen);
  });
}

AxisEstimate AxisEstimator::Update(const Input& in) noexcept {
  AxisEstimate estimate;
  WithOne(one_, [&](auto& one) noexcept { estimate = one.Update(in); });
  return estimate;
}

void AxisEstimator::PreviewFriction(const AxisHorizon& reference, std::size_t points,
                                    FrictionPreview& out) noexcept {
  WithOne(one_, [&](auto& one) noexcept {
    if constexpr (requires { one.PreviewFriction(reference, points, out); }) {
      one.PreviewFriction(reference, points, out);
    } else {
      double ahead_N = 0.0;
      if constexpr (requires { one.FrictionAhead_N(); }) ahead_N = one.FrictionAhead_N();
      out.resize(std::min(points, reference.size()));
      for (auto& f : out) f = {ahead_N, ahead_N, 0.0};
    }
  });
}

void AxisEstimator::Keep(StateKeeper& keep) noexcept {
  WithOne(one_, [&](auto& one) noexcept { keep(one); });
}

}  // namespace contour
