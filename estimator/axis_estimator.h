#pragma once

#include <cstdint>
#include <variant>

#include "core/axis.h"
#include "core/horizon.h"
#include "core/mechanics.h"
#include "core/state_keeper.h"
#include "estimator/axis_estimator_input.h"
#include "estimator/disturbance_observer.h"
#include "estimator/estimator_config.h"
#include "estimator/four_state_filter.h"
#include "estimator/friction_config.h"
#include "estimator/full_estimator.h"
#include "estimator/kinematic_observer.h"
#include "estimator/known_effects.h"
#include "estimator/seven_state_filter.h"
#include "estimator/two_inertia_estimator.h"

namespace contour {

enum class EstimatorKind : std::uint8_t {
  kKinematic,            ///< position and velocity only; no friction
  kDisturbanceObserver,  ///< Kalman filter [p, v, d]
  kSrukf4,               ///< the paper's four states, corrected
  kEkf7,                 ///< the seven states in an extended Kalman filter
  kSrukf7,               ///< seven states in a square-root unscented Kalman filter
  kFull,                 ///< kSrukf7, level learnt over turn and speed, friction rolled along the reference
  kFullInCascade,        ///< kFull, for a drive that closes its own position loop and reports its torque
  kTwoInertia,           ///< two inertias, friction learnt along the reference; built from a Setup of its own
};

/// State, velocity and friction of one axis from its motor encoder and the torque sent to it.
/// One Update per cycle, then PreviewFriction if wanted. Nothing allocates after construction.
class AxisEstimator {
 public:
  using Input = AxisEstimatorInput;

  /// resolution_m: one encoder count at the table; 0 when unknown. lag_s: time constant of the drive's
  /// current loop. `known`: what `full` takes as given beside the model. Throws std::invalid_argument when a
  /// value makes no sense (not positive, not finite).
  AxisEstimator(EstimatorKind kind, const Mechanics& mechanics, const FrictionConfig& friction,
                const EstimatorConfig& config, double period_s, double lag_s, double resolution_m = 0.0,
                KnownEffects known = {});
  /// The axis as two inertias, with friction learnt along the reference.
  explicit AxisEstimator(const TwoInertiaEstimator::Setup& setup);
  /// From the same numbers as above.
  static FilterSetup SetupOf(const Mechanics& mechanics, const FrictionConfig& friction,
                             const EstimatorConfig& config, double period_s, double lag_s,
                             double resolution_m);

  /// Starts anew at a position, at rest; friction parameters as commissioned.
  void Reset(double position_m) noexcept;

  /// Where the axis is for who places a reference: its table by a linear scale that is believed, or else the
  /// motor, which is at `position_m`.
  [[nodiscard]] double StandsAt_m(double position_m) const noexcept {
    const auto* two = std::get_if<TwoInertiaEstimator>(&one_);
    return two != nullptr ? two->StandsAt_m(position_m) : position_m;
  }

  /// From now on nothing is learnt, and the bristle's stiffness goes back to the commissioned one; false:
  /// learning goes on from there. Only where there is something that is learnt.
  void Freeze(bool frozen) noexcept;

  /// Filter at t(k-1) and prediction to t(k).
  AxisEstimate Update(const Input& in) noexcept;

  /// Total friction (bristle, viscous, disturbance) expected along the reference; out gets `points` elements,
  /// or as many as the reference has. Zero for kKinematic.
  void PreviewFriction(const AxisHorizon& reference, std::size_t points, FrictionPreview& out) noexcept;

  void Keep(StateKeeper& keep) noexcept;

 private:
  std::variant<KinematicObserver, DisturbanceObserver, FourStateFilter,
               SevenStateFilter<SqrtEkf<kSevenStates>>, SevenStateFilter<SqrtUkf<kSevenStates>>,
               FullEstimator, TwoInertiaEstimator>
      one_;
};

}  // namespace contour
