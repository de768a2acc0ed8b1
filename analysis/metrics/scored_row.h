#pragma once

#include <limits>

#include "core/axis.h"
#include "core/cycle_record.h"

namespace contour {

inline constexpr double kNoTruth = std::numeric_limits<double>::quiet_NaN();

/// What scoring needs of one axis at one instant.
struct ScoredAxis {
  double reference_m = 0.0;
  double encoder_m = 0.0;                 ///< R theta
  double table_m = kNoTruth;              ///< true position of the table
  double friction_estimate_N = kNoTruth;  ///< total
  double friction_truth_N = kNoTruth;     ///< total
  bool torque_saturated = false;
};

/// What scoring needs of one cycle of a program. All positions belong to the same instant.
struct ScoredRow {
  double path_time_s = 0.0;  ///< since the start of the program
  PerAxis<ScoredAxis> axes;
};

/// A row of a cycle's record, without a truth. `estimates_friction`: the controller has an estimator.
ScoredRow RowOf(const CycleRecord& record, bool estimates_friction);

}  // namespace contour
