#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <variant>

#include "core/axis.h"
#include "core/horizon.h"
#include "core/mechanics.h"
#include "core/state_keeper.h"
#include "estimator/angle_force_map.h"
#include "estimator/axis_estimator_input.h"
#include "estimator/disturbance_observer.h"
#include "estimator/drive_lag.h"
#include "estimator/estimator_config.h"
#include "estimator/four_state_filter.h"
#include "estimator/friction_config.h"
#include "estimator/friction_preview.h"
#include "estimator/kinematic_observer.h"
#include "estimator/known_effects.h"
#include "estimator/level_correction.h"
#include "estimator/momentum_balance.h"
#include "estimator/seven_state_filter.h"
#include "estimator/two_inertia_estimator.h"
#include "estimator/viscous_correction.h"
#include "estimator/wind_up_fit.h"

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

  /// From now on nothing is learnt, and the bristle's stiffness goes back to the commissioned one; false:
  /// learning goes on from there. Only where there is something that is learnt.
  void Freeze(bool frozen) noexcept;

  /// Filter at t(k-1) and prediction to t(k).
  AxisEstimate Update(const Input& in) noexcept;

  /// Total friction (bristle, viscous, disturbance) expected along the reference; out gets `points` elements,
  /// or as many as the reference has. Zero for kKinematic.
  void PreviewFriction(const AxisHorizon& reference, std::size_t points, FrictionPreview& out) noexcept;

  /// The extensions of the model stay as constructed.
  void Keep(StateKeeper& keep) noexcept {
    keep(filter_, roll_, correction_, viscous_, momentum_, map_, wind_up_, lag_, drive_N_, temperature_degC_,
         at_rest_, frozen_, followed_, knows_followed_, two_inertia_);
  }

 private:
  [[nodiscard]] bool is_full() const noexcept {
    return kind_ == EstimatorKind::kFull || kind_ == EstimatorKind::kFullInCascade;
  }
  AxisEstimate UpdateFull(const Input& in) noexcept;
  void LearnWindUp(double position_m, double velocity_m_s, double force_N, bool alone,
                   const AxisEstimate& estimate) noexcept;

  EstimatorKind kind_;
  std::variant<KinematicObserver, DisturbanceObserver, FourStateFilter,
               SevenStateFilter<SqrtEkf<kSevenStates>>, SevenStateFilter<SqrtUkf<kSevenStates>>>
      filter_;
  FrictionRoll roll_;
  LevelCorrection correction_;
  ViscousCorrection viscous_;
  MomentumBalance momentum_;
  AngleForceMap map_;
  WindUpFit wind_up_;
  DriveLag<1> lag_;
  double drive_N_ = 0.0;  // mean over the period before
  double mass_kg_ = 0.0;
  double table_mass_kg_ = 0.0;
  KnownEffects known_;
  double temperature_degC_ = std::numeric_limits<double>::quiet_NaN();
  bool at_rest_ = true;
  bool frozen_ = false;
  /// Of what is followed, at the next sample: where corners are planned it is not the program's own motion.
  ReferencePoint followed_;
  bool knows_followed_ = false;
  std::unique_ptr<TwoInertiaEstimator> two_inertia_;  ///< does everything, where it is
};

}  // namespace contour
