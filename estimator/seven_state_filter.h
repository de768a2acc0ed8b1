#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/axis.h"
#include "core/wide_vectors.h"
#include "estimator/axis_estimator_input.h"
#include "estimator/disturbance_band.h"
#include "estimator/drive_lag.h"
#include "estimator/filter_setup.h"
#include "estimator/seven_state_model.h"
#include "estimator/sqrt_ekf.h"
#include "estimator/sqrt_ukf.h"

namespace contour {

/// Position, velocity and LuGre friction of one axis with its drifting parameters, by either core filter
/// (SqrtUkf<7>, SqrtEkf<7>). Around the core: process noise scaled by motion, only the active direction's
/// level adapted, sigma0 only in presliding, parameters kept at rest, bounds, and the encoder corrected to
/// the centre of mass. docs/estimator.md says why.
template <class Core>
class SevenStateFilter {
 public:
  SevenStateFilter() noexcept = default;
  explicit SevenStateFilter(const FilterSetup& setup) noexcept;

  void Reset(double position_m) noexcept;
  /// Levels keep their values; sigma0 goes back to the commissioned one, smoothly.
  void Freeze(bool frozen) noexcept { frozen_ = frozen; }

  /// Filter at the sample t(k-1) and prediction to t(k). Factors of the level may be set before.
  AxisEstimate Update(const AxisEstimatorInput& in) noexcept;

  void SetLevelFactors(double plus, double minus) noexcept {
    factor_plus_ = plus;
    factor_minus_ = minus;
  }

  /// Forces that accelerate what the axis is heavier, and push what it is more viscous, than commissioned.
  /// The latter counts as friction. `mass_variance_left`: of what the mass was uncertain by when
  /// commissioned.
  void SetKnownForces_N(double inertial_N, double viscous_N, double mass_variance_left) noexcept {
    inertial_N_ = inertial_N;
    viscous_N_ = viscous_N;
    mass_variance_left_ = mass_variance_left;
  }

  /// Forces on the motor beside the command's, over [t(k-2), t(k-1)) and from t(k-1) on.
  void SetDrivingForces_N(double before, double ahead) noexcept {
    driving_before_N_ = before;
    driving_ahead_N_ = ahead;
  }

  /// Forces known to pull at the table, towards positive position, at the sample and at t(k): part of the
  /// driving forces, and of what winds the screw up.
  void SetTableForces_N(double now, double ahead) noexcept {
    table_now_N_ = now;
    table_ahead_N_ = ahead;
  }

  /// Mean state at the sample and at t(k).
  [[nodiscard]] const StateVector<kSevenStates>& state() const noexcept { return core_.x; }
  [[nodiscard]] const StateVector<kSevenStates>& predicted() const noexcept { return predicted_; }
  [[nodiscard]] const SevenStateModel& model() const noexcept { return model_; }
  /// Of the mean state.
  [[nodiscard]] double sigma0_N_m() const noexcept { return sigma0_N_m_; }
  /// Friction (bristle, viscous, disturbance) in the middle of the interval in which the next torque acts.
  [[nodiscard]] double FrictionAhead_N() const noexcept { return friction_ahead_N_; }
  /// The part of the disturbance that is an outside force for certain, because friction cannot be that wrong.
  [[nodiscard]] double lasting_N() const noexcept { return lasting_N_; }
  /// Level G in the direction of motion, Stribeck curve and factors included.
  [[nodiscard]] double Level_N() const noexcept {
    return model_.Level(core_.x, at_, {{}, factor_plus_, factor_minus_});
  }

 private:
  using X = StateVector<kSevenStates>;

  /// `at`: the terms at the mean's velocity.
  [[nodiscard]] SevenStateInput Input(const SpeedTerms& at,
                                      std::array<double, kSubsteps> force_N) const noexcept {
    for (double& f : force_N) f += driving_N_ - inertial_N_ - viscous_N_;
    return {force_N, factor_plus_, factor_minus_, at.sigma1_Ns_m, at_rest_, lasting_N_};
  }
  [[nodiscard]] double Total_N(const X& x, const SpeedTerms& at) const noexcept {
    return model_.Friction_N(x, at, Input(at, {})) + viscous_N_;
  }
  /// Level of the direction of motion: the state, and what it was commissioned with.
  [[nodiscard]] SevenState LevelState() const noexcept {
    return core_.x[kVelocity] >= 0.0 ? kLevelPlus : kLevelMinus;
  }
  [[nodiscard]] double CommissionedLevel_N() const noexcept {
    return LevelState() == kLevelPlus ? setup_.friction.Fc_plus_N : setup_.friction.Fc_minus_N;
  }
  [[nodiscard]] bool adapts() const noexcept { return setup_.config.adapt && !frozen_; }
  void Follow(double position_m) noexcept;
  void Reverse(double commanded_velocity_m_s) noexcept;
  CONTOUR_WIDE_VECTORS void TimeUpdate(const AxisEstimatorInput& in) noexcept;
  CONTOUR_WIDE_VECTORS UpdateResult MeasurementUpdate(const AxisEstimatorInput& in,
                                                      Innovation& innovation) noexcept;
  [[nodiscard]] StateMask<kSevenStates> Adapted(bool at_rest) const noexcept;
  void JudgeLevel(bool at_rest) noexcept;
  void TakeLevelBack(double held_N, double least_N) noexcept;
  void HoldLastingForce() noexcept;
  void ShareAsymmetry() noexcept;
  bool Bound() noexcept;
  CONTOUR_WIDE_VECTORS void Tell(const AxisEstimatorInput& in, AxisEstimate& out) noexcept;
  void LookAhead(const AxisEstimatorInput& in) noexcept;
  [[nodiscard]] double FrictionStd_N() const noexcept;
  [[nodiscard]] double WindUpShare_m(double total_N, double disturbance_N, double force_N,
                                     double table_N) const noexcept;

  FilterSetup setup_;
  SevenStateModel model_;
  DriveLag<kSubsteps> lag_;
  SuddenGate gate_;
  X noise_{};
  double timing_noise_s_kg_ = 0.0;  // velocity by change of the force from one period to the next
  double motion_gate_m_s_ = 0.0;
  double mass_std_kg_ = 0.0;
  // Variance of the force that a wrong mass takes. What has been learnt of the mass takes that away, but
  // where it was found far off it is known by no more than that share of what it was off by.
  double mass_N2_ = 0.0;
  // In csp what the mass is off by is no friction: where presliding is over within two readings sigma0 took
  // it up, and with it, turn by turn, the error (10 m/min, inertias 30 % larger: 1.2 to 2.3 um). 0 with
  // commanded torques: no drive makes up for the mass there, and what friction takes up of it helps.
  double mass_noise_s2_kg2_ = 0.0;
  double lasting_share_ = 0.0;  // shares per period
  double asymmetry_share_ = 0.0;
  double surprise_share_ = 0.0;
  DisturbanceBand band_;
  double forget_share_ = 0.0;
  X std_limit_{};
  X initial_std_{};
  Core core_;
  SpeedTerms at_;  // at the velocity of core_.x, whenever that has changed
  X predicted_{};
  double sigma0_N_m_ = 0.0;  // of core_.x, at the end of Update
  double factor_plus_ = 1.0;
  double factor_minus_ = 1.0;
  double inertial_N_ = 0.0;
  double mass_variance_left_ = 1.0;
  double viscous_N_ = 0.0;
  double driving_before_N_ = 0.0;
  double driving_ahead_N_ = 0.0;
  double driving_N_ = 0.0;  // of the two, the one at work
  double table_now_N_ = 0.0;
  double table_ahead_N_ = 0.0;
  int direction_ = 0;  // last commanded one; 0 none yet
  double friction_ahead_N_ = 0.0;
  double travel_m_ = 0.0;  // in one direction
  double travel_s_ = 0.0;
  int travel_direction_ = 0;
  double lasting_N_ = 0.0;
  bool at_rest_ = true;
  double last_position_m_ = 0.0;  // of the newest measurement, believed or not
  double periods_since_position_ = 1.0;
  double surprise_ = 1.0;  // mean square of innovation / its standard deviation
  std::uint32_t gated_in_a_row_ = 0;
  bool following_ = true;
  bool frozen_ = false;
};

extern template class SevenStateFilter<SqrtUkf<kSevenStates>>;
extern template class SevenStateFilter<SqrtEkf<kSevenStates>>;

}  // namespace contour
