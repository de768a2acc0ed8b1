#include "tools/diagnosis/lane_linear.h"
#include "tools/diagnosis/lane_run.h"
// The loops themselves, translated with this file's flags.
#include "tools/diagnosis/lane_linear.inc"
#include "tools/diagnosis/lane_run.inc"

namespace contour::diagnosis {

void RunLanesAvx512(const Lanes& m) { RunAll(m); }
void RunColumnsAvx512(const LaneColumns& m) { ColumnsAll(m); }
void RunWhitenAvx512(const LaneWhiten& m) { WhitenAll(m); }

}  // namespace contour::diagnosis
