#pragma once

#include <vector>

#include "daemon/learning/measured_pass.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program/path_offsets.h"

namespace contour {

/// What a pass missed the path by: from the table to the nearest point of the path, axis by axis. Being late
/// along the path is no error of the contour and is left out; at rest there is no along.
struct ErrorAcross {
  std::vector<std::vector<float>> error_m;  ///< [axis][grid point]; 0 where nothing is known
  double late_s = 0.0;                      ///< by how much the table was late on the path, on average
};

/// `followed`: what the reference was shifted by on that pass; null: nothing.
ErrorAcross FindErrorAcross(const MotionPlan& plan, const MeasuredPass& pass, const PathOffsets* followed,
                            double period_s);

}  // namespace contour
