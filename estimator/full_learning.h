#pragma once

#include "core/state_keeper.h"
#include "estimator/angle_force_map.h"
#include "estimator/filter_setup.h"
#include "estimator/level_correction.h"
#include "estimator/momentum_balance.h"
#include "estimator/viscous_correction.h"
#include "estimator/wind_up_fit.h"

namespace contour {

/// All that FullEstimator learns beside its filter's states, how fast and how far, and what it has learnt.
/// With `adapt` off in the setup every rate is 0 and all of it stays as commissioned.
struct FullLearning {
  explicit FullLearning(const FilterSetup& setup);

  /// As commissioned.
  void Reset() noexcept;
  /// A sample that says nothing: what needs samples in a row starts a new one.
  void Pause() noexcept {
    momentum.Pause();
    wind_up.Pause();
  }
  void Keep(StateKeeper& keep) noexcept { keep(level, viscous, momentum, map, wind_up); }

  LevelCorrection level;      ///< of friction, over the screw's turn and the speed
  ViscousCorrection viscous;  ///< N s/m beside the commissioned sigma2
  MomentumBalance momentum;   ///< mass beside the commissioned one, and delay of the torque
  AngleForceMap map;          ///< force on the motor over the screw's turn: cogging
  WindUpFit wind_up;          ///< compliance beside the commissioned stiffness
};

}  // namespace contour
