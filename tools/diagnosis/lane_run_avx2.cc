#include "tools/diagnosis/lane_run.h"
// The loops themselves, translated with this file's flags.
#include "tools/diagnosis/lane_run.inc"

namespace contour::diagnosis {

void RunLanesAvx2(const Lanes& m) { RunLanes(m); }

}  // namespace contour::diagnosis
