#include "tools/diagnosis/lane_linear.h"
#include "tools/diagnosis/lane_run.h"
// The loops themselves, translated with this file's flags.
#include "tools/diagnosis/lane_linear.inc"
#include "tools/diagnosis/lane_run.inc"

namespace contour::diagnosis {

void RunLanesAvx2(const Lanes& m) { RunAll(m); }
void RunColumnsAvx2(const LaneColumns& m) { ColumnsAll(m); }
void RunWhitenAvx2(const LaneWhiten& m) { WhitenAll(m); }

}  // namespace contour::diagnosis
