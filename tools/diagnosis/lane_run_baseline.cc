#include "tools/diagnosis/lane_linear.h"
#include "tools/diagnosis/lane_run.h"
// The loops themselves, translated with this file's flags.
#include "tools/diagnosis/lane_linear.inc"
#include "tools/diagnosis/lane_run.inc"

namespace contour::diagnosis {

void RunLanesBaseline(const Lanes& m) { RunAll(m); }
void RunColumnsBaseline(const LaneColumns& m) { ColumnsAll(m); }
void RunWhitenBaseline(const LaneWhiten& m) { WhitenAll(m); }

}  // namespace contour::diagnosis
