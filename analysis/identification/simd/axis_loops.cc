#include "analysis/identification/simd/axis_loops.h"

#include "analysis/identification/simd/axis_lanes.h"
#include "analysis/prediction_error/simd/lane_loops.h"

namespace contour::identify {

void RunAxisLanes(const AxisLanes& lanes) {
  if (diagnosis::HasAvx2())
    RunAxisLanesAvx2(lanes);
  else
    RunAxisLanesBaseline(lanes);
}

}  // namespace contour::identify
