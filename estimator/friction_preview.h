#pragma once

#include "core/horizon.h"
#include "core/state_keeper.h"
#include "estimator/angle_force_map.h"
#include "estimator/known_effects.h"
#include "estimator/level_correction.h"
#include "estimator/reference_terms.h"
#include "estimator/seven_state_model.h"
#include "estimator/viscous_correction.h"

namespace contour {

/// What is known beside the filter's state.
struct KnownNow {
  const KnownEffects& effects;  ///< extensions of the model, at the present temperature
  double temperature_degC;
  const AngleForceMap& map;
  double extra_kg;    ///< by which the axis is heavier than commissioned
  double lasting_N;   ///< the part of the disturbance that is an outside force for certain
  double sigma0_N_m;  ///< as the filter's state has it
  bool learns = true;
};

/// Friction the reference motion will meet: the bristle rolled along the reference with the levels and
/// stiffness estimated now, plus the present difference between the estimated bristle and the rolled one,
/// plus the disturbance held. Driven by the reference, not by the measured motion, it carries no noise and
/// does not depend on the feedback loop.
class FrictionRoll {
 public:
  FrictionRoll() noexcept = default;
  /// `cascade`: a drive closes the position loop itself and answers at once to what friction is not foreseen.
  /// Fed forward a second time from here, cycles later, it would swing. So the torque has none of it, nor of
  /// a mass the drive knows; the wind-up has it, through a low-pass.
  explicit FrictionRoll(double period_s, bool cascade = false) noexcept;

  [[nodiscard]] double period_s() const noexcept { return period_s_; }

  /// Friction along the reference from element 0 to 1 of the last Run, by the model alone, less known forces
  /// on the motor: nothing that was estimated of a disturbance is in it.
  [[nodiscard]] double rolled_N() const noexcept { return rolled_N_; }

  /// The rolled bristle starts from this force.
  void Reset(double bristle_N) noexcept {
    bristle_N_ = bristle_N;
    lead_N_ = 0.0;
    moved_ = false;
  }

  /// The terms along the reference are not part of the state: they are the same however they were come by.
  void Keep(StateKeeper& keep) noexcept { keep(bristle_N_, rolled_N_, lead_N_, moved_); }

  /// `x`: filter state at element 0 of the reference, of which `points` are rolled along. Keeps the bristle
  /// at element 1 for the next call and lets the corrections learn from the difference at element 0. mid_N,
  /// which the torque must overcome, has what the axis is heavier than commissioned in it, and known forces
  /// on the motor; node_N, which winds the screw up, has not.
  void Run(const SevenStateModel& model, const StateVector<kSevenStates>& x, LevelCorrection& correction,
           ViscousCorrection& viscous, const KnownNow& known, bool at_rest, const AxisHorizon& reference,
           std::size_t points, FrictionPreview& out) noexcept;

 private:
  double period_s_ = 1e-3;
  double bristle_N_ = 0.0;  // rolled, at element 0 of the next reference
  double rolled_N_ = 0.0;
  bool cascade_ = false;
  double lead_share_ = 1.0;  // of the low-pass, per period
  double rest_share_ = 1.0;
  double lead_N_ = 0.0;  // unforeseen friction as the wind-up has it
  bool moved_ = false;   // since the start
  ReferenceTerms terms_;
};

}  // namespace contour
