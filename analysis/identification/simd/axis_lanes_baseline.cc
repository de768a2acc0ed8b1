#include <cmath>
#include <cstdint>

#include "analysis/identification/simd/axis_lanes.h"
#include "analysis/identification/simd/axis_loops.h"
// The loop itself, translated with this file's flags.
#include "analysis/identification/simd/wide.inc"

#include "analysis/identification/simd/axis_lanes.inc"

namespace contour::identify {

void RunAxisLanesBaseline(const AxisLanes& lanes) { RunBundle(lanes); }

}  // namespace contour::identify
