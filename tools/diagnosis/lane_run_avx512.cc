#include "tools/diagnosis/lane_linear.h"
#include "tools/diagnosis/lane_loops.h"
#include "tools/diagnosis/lane_run.h"
// The loops themselves, translated with this file's flags.
#include "tools/diagnosis/lane_linear.inc"
#include "tools/diagnosis/lane_run.inc"

namespace contour::diagnosis {

const LaneLoops kAvx512Loops = {RunAll, RunBoth, ColumnsAll, WhitenAll, ProductsAll};

}  // namespace contour::diagnosis
