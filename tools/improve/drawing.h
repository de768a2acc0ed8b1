#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "analysis/metrics/truth_table.h"
#include "analysis/recording/axis_log.h"
#include "config/machine_config.h"
#include "core/cycle_record.h"
#include "daemon/program/motion_plan.h"
#include "estimator/known_effects.h"
#include "tools/improve/working_space.h"

namespace contour::improve {

/// One axis in one cycle of a program that was drawn.
struct DrawnAxis {
  double reference_m = 0.0, acceleration_m_s2 = 0.0;
  double encoder_m = 0.0;
  double scale_m = 0.0;  ///< NaN without one
  double friction_N = 0.0;
  double angle_rad = 0.0;
};
struct DrawnCycle {
  double path_time_s = 0.0;
  std::uint64_t feedback_sync = 0;
  PerAxis<DrawnAxis> axes;
};

/// A program as it was drawn once.
struct Drawing {
  std::vector<DrawnCycle> cycles;
  diagnosis::AxisLog log;  ///< of the improved axis
  PerAxis<double> start_m;
  PerAxis<KnownEffects> known;  ///< of the models it was drawn with: forces that were not told as friction
  std::uint64_t lost = 0;       ///< cycles that never arrived
};

/// What the models of a machine state beside mechanics and friction.
PerAxis<KnownEffects> KnownOf(const MachineConfig& machine);

/// Takes the cycles in which a program ran.
void AddCycle(const CycleRecord& record, Drawing& drawing);

/// Largest and root mean square distance from the path, um; on a machine of one axis, of which a path is
/// never left, the following error's.
struct PathError {
  double peak_um = 0.0, rms_um = 0.0;
};
struct PathErrors {
  PathError encoder;               ///< of the motors
  PathError believed;              ///< less what the screws are wound up by, by one model for all drawings
  std::optional<PathError> scale;  ///< of the linear scales
  std::optional<PathError> truth;  ///< of the emulated machine
};

/// What stands between motor and table, by the model that is known best: the same one for drawings before and
/// after, or a model would be judged by itself.
PathErrors ErrorsOf(const Drawing& drawing, const ProgramText& program, const PerAxis<PlanLimits>& limits,
                    const MachineConfig& yardstick, const TruthTable* truth);

}  // namespace contour::improve
