#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/control_config.h"
#include "core/axis.h"
#include "core/controller_name.h"
#include "core/loop_limits.h"
#include "core/loop_tuning.h"
#include "core/mechanics.h"
#include "core/side_mode.h"
#include "core/two_inertia_axis.h"
#include "core/watch.h"
#include "drivers/cia402/drive_master.h"
#include "estimator/estimator_config.h"
#include "estimator/friction_config.h"
#include "estimator/known_effects.h"

namespace contour {

/// All the cycle needs to know of one axis.
struct CycleAxisConfig {
  std::string name;
  Mechanics mechanics;
  FrictionConfig friction;
  KnownEffects known;
  std::vector<SideMode> side_modes;
  EstimatorConfig estimator;
  AxisLimits limits;
  /// Of the drive, a dead time of part of a period among it, for what knows one inertia.
  double lag_s = 0.0;
  TwoInertiaAxis two_inertia;  ///< for what knows two
  double encoder_counts_per_rev = 0.0;
  std::optional<LoopTuning> loop;             ///< of the two-inertia loop, where the file has one
  double peak_late = LoopLimits{}.peak_late;  ///< that this loop was allowed
  bool has_scale = false;
  std::optional<LoopTuning> scale_loop;  ///< of the one that goes by the linear scale
};

/// All the cycle needs to know; it never sees a file.
struct CycleConfig {
  std::uint32_t cycle_us = 1000;
  ControllerName controller = ControllerName::kFull;
  ControllerConfig control;
  MasterConfig master;
  std::vector<CycleAxisConfig> axes;
  WatchesOff off;  ///< for tests alone
};

}  // namespace contour
