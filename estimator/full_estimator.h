#pragma once

#include <limits>

#include "core/axis.h"
#include "core/horizon.h"
#include "core/state_keeper.h"
#include "estimator/axis_estimator_input.h"
#include "estimator/drive_lag.h"
#include "estimator/filter_setup.h"
#include "estimator/friction_preview.h"
#include "estimator/full_learning.h"
#include "estimator/known_effects.h"
#include "estimator/seven_state_filter.h"
#include "estimator/wind_up_tuning.h"

namespace contour {

/// Friction of one axis by the square-root unscented Kalman filter of seven states, with what it learns
/// beside its states, and rolled along the reference.
class FullEstimator {
 public:
  /// `setup.reported_torque`: a drive closes its own position loop and reports its torque. `known`: what is
  /// given beside the model.
  FullEstimator(const FilterSetup& setup, KnownEffects known);

  /// Starts anew at a position, at rest; everything as commissioned.
  void Reset(double position_m) noexcept;
  void Freeze(bool frozen) noexcept;
  AxisEstimate Update(const AxisEstimatorInput& in) noexcept;
  void PreviewFriction(const AxisHorizon& reference, std::size_t points, FrictionPreview& out) noexcept;

  void Keep(StateKeeper& keep) noexcept {
    keep(filter_, roll_, learnt_, lag_, drive_N_, temperature_degC_, at_rest_, frozen_, followed_,
         knows_followed_);
  }

 private:
  using Filter = SevenStateFilter<SqrtUkf<kSevenStates>>;

  [[nodiscard]] AxisEstimatorInput Followed(const AxisEstimatorInput& in) noexcept;
  [[nodiscard]] double Driving_N(double position_m, double velocity_m_s) const noexcept;
  void TellKnownForces(const AxisEstimatorInput& followed) noexcept;
  void Learn(const AxisEstimatorInput& followed, double force_N, const AxisEstimate& estimate) noexcept;
  void LearnWindUp(const AxisEstimatorInput& followed, double force_N, const AxisEstimate& estimate) noexcept;

  Filter filter_;
  FrictionRoll roll_;
  FullLearning learnt_;
  DriveLag<1> lag_;
  double mass_kg_;
  double table_mass_kg_;
  double before_screw_;   ///< share of the friction that acts there
  double stiffness_std_;  ///< of the screw, relative, as commissioned
  KnownEffects known_;
  double drive_N_ = 0.0;  ///< mean over the period before
  double temperature_degC_ = std::numeric_limits<double>::quiet_NaN();
  bool at_rest_ = true;
  bool frozen_ = false;
  /// Of what is followed, at the next sample: where corners are planned it is not the program's own motion.
  ReferencePoint followed_;
  bool knows_followed_ = false;
};

}  // namespace contour
