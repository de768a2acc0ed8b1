#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/axis.h"
#include "core/horizon.h"
#include "core/state_keeper.h"
#include "core/two_inertia_loop.h"
#include "estimator/angle_force_map.h"
#include "estimator/axis_estimator_input.h"
#include "estimator/cascade_lead.h"
#include "estimator/disturbance_band.h"
#include "estimator/drive_lag.h"
#include "estimator/filter_setup.h"
#include "estimator/friction_along.h"
#include "estimator/friction_learner.h"
#include "estimator/known_effects.h"
#include "estimator/momentum_balance.h"
#include "estimator/resting_bristles.h"
#include "estimator/side_mode_force.h"
#include "estimator/table_scale.h"
#include "estimator/two_inertia_observer.h"
#include "estimator/wind_up_fit.h"
#include "estimator/wind_up_tuning.h"

namespace contour {

/// One axis as two inertias: TwoInertiaObserver for what it does, FrictionLearner for the friction along its
/// reference. What the observer finds beyond the friction that was expected teaches the learner, and nothing
/// of the friction is a state of the loop. Where a drive closes its own loop the torque that it reports takes
/// the place of the command.
class TwoInertiaEstimator {
 public:
  struct Setup {
    FilterSetup filter;
    TwoInertiaAxis axis;
    TwoInertiaLoop loop;
    double position_min_m = -1.0, position_max_m = 1.0;
    KnownEffects known;
    std::vector<SideMode> side_modes;
    double acceleration_m_s2 = 10.0;  ///< of paths, at most
    double sample_jitter_s = 0.0;     ///< by which a SYNC may come late or early
    bool has_scale = false;
    double scale_count_m = 0.0;                  ///< what its readings are rounded to
    double external_force_N = 0.0;               ///< besides friction, at most; a weight may be as large
    std::optional<TwoInertiaLoop> scale_loop{};  ///< of the loop that goes by the linear scale
  };

  /// Of the force that accelerates the axis: what it is off by beside the mass, and of viscous friction.
  static constexpr double kInertialPart = 0.03;

  /// Throws std::invalid_argument when a value makes no sense.
  explicit TwoInertiaEstimator(const Setup& setup);

  void Reset(double position_m) noexcept;
  void Freeze(bool frozen) noexcept { frozen_ = frozen; }
  AxisEstimate Update(const AxisEstimatorInput& in) noexcept;
  /// Friction along the reference, without what only the observer knows; in a cascade, where nobody else
  /// answers it, with that as far as it lasts.
  void PreviewFriction(const AxisHorizon& reference, std::size_t points, FrictionPreview& out) noexcept;

  /// What the drive gave over the period that ended with the newest sample, by its lag; the mean.
  [[nodiscard]] double acted_N() const noexcept { return acted_N_; }
  [[nodiscard]] const FrictionLearner& learner() const noexcept { return learner_; }
  /// Where the axis is for who places a reference: its table by the linear scale, or else the motor.
  [[nodiscard]] double StandsAt_m(double position_m) const noexcept {
    return scale_ && scale_->believed() ? scale_->table_m() : position_m;
  }

  void Keep(StateKeeper& keep) noexcept;

 private:
  /// At a point of the reference.
  struct Node {
    double friction_N = 0.0;  ///< of motor and table, but for sigma2 v
    double heavier_N = 0.0;   ///< for what the axis is heavier than commissioned, all of it
    double learnt_N = 0.0;    ///< all that follows from what is learnt
    double driving_N = 0.0;   ///< known on the motor, beside the drive's
    double pulling_N = 0.0;   ///< known on the table, towards positive position
    double table_N = 0.0;     ///< of all of it on the table, against positive motion, but for sigma2 v
    double inertia_N = 0.0;   ///< for what the motor is heavier than commissioned
    double motor_N = 0.0;     ///< on the motor, towards positive position
    double beyond_m = 0.0;    ///< of the motor before the table beyond the commissioned wind-up
  };
  void Lay() noexcept;
  [[nodiscard]] const Node& At(std::size_t point) const noexcept;
  [[nodiscard]] PeriodForces Forces(std::size_t period, bool ahead) const noexcept;
  [[nodiscard]] double NoiseTakes_s() const noexcept;
  [[nodiscard]] double WindsUp_N(double unforeseen_N) const noexcept;
  [[nodiscard]] double Expected_N(std::size_t period) const noexcept;
  [[nodiscard]] double Motor_N(std::size_t period) const noexcept;
  [[nodiscard]] double Wound_N(std::size_t point) const noexcept;
  void Remember(const AxisEstimatorInput& in) noexcept;
  // In two_inertia_scale.cc:
  static std::unique_ptr<TableScale> MakeScale(const Setup& setup, double level_N, double most_N);
  [[nodiscard]] double MotorExtra_kg() const noexcept;
  void Begin(double position_m) noexcept;
  void ReadScale(const AxisEstimatorInput& in) noexcept;
  TwoInertiaObserver::Seen Correct(const AxisEstimatorInput& in) noexcept;
  void LeaveScale(double position_m) noexcept;
  /// What the table is heavier than commissioned: what the axis is less what the motor is, as far as that
  /// leaves a table.
  [[nodiscard]] double TableExtra_kg(double axis_kg, double motor_kg) const noexcept;
  void Learn(const AxisEstimatorInput& in, bool may) noexcept;
  void LearnMotor(double position_m) noexcept;
  void LearnWindUp(const AxisEstimatorInput& in) noexcept;
  void Rest() noexcept;
  [[nodiscard]] double MassStd_kg() const noexcept;
  void Doubt(double acceleration_m_s2) noexcept;
  [[nodiscard]] ScrewStiffness Stiffness() const noexcept;
  [[nodiscard]] AxisEstimate Believed(const AxisEstimatorInput& in) const noexcept;

  FilterSetup setup_;
  TwoInertiaAxis axis_;
  KnownEffects known_;
  FrictionAlong along_;
  SideModeForce side_;
  std::array<Node, FrictionAlong::kMost> nodes_{};
  TwoInertiaObserver observer_;
  FrictionLearner learner_;
  AngleForceMap map_;        ///< force on the motor over the screw's turn: cogging
  MomentumBalance balance_;  ///< for what is missing; by a scale it learns what the mass still lacks
  WindUpFit wind_up_;
  DriveLag<1> lag_;
  std::unique_ptr<TableScale> scale_;  ///< none: there is no linear scale
  bool loop_takes_scale_ = false;
  bool by_scale_ = false;  ///< the observer goes by it
  CascadeLead lead_;
  RestingBristles resting_;
  double most_N_ = 0.0;        ///< that friction along the reference may be
  double motor_share_ = 0.0;   ///< of the mass
  double before_screw_ = 0.0;  ///< share of the friction that acts there
  DisturbanceBand band_;
  double surprise_share_ = 1.0;     ///< per period
  bool reports_are_noise_ = false;  ///< of the drive's readings, as far as they scatter
  std::size_t settle_ = 1;          ///< periods in which the observer sees half of a force

  std::array<double, kLoopQueue + 1> given_N_{};  ///< to the drive, newest first
  double acted_N_ = 0.0;
  static constexpr std::size_t kFound = 32;
  std::array<double, kFound> found_N_{};  ///< disturbance at the samples before, a ring
  std::size_t newest_ = 0;
  double surprise_N2_ = 0.0;    ///< mean square of what it changes by until the observer sees a change
  double noise_N2_ = 0.0;       ///< of it that is noise of single samples
  double variance_N2_ = 0.0;    ///< of what is believed of friction
  double unexplained_N_ = 0.0;  ///< disturbance, had what is known by now been known all along
  std::size_t elapsed_ = 0;     ///< samples since friction was laid along the reference
  double temperature_degC_ = std::numeric_limits<double>::quiet_NaN();
  bool at_rest_ = true;
  bool frozen_ = false;
};

}  // namespace contour
