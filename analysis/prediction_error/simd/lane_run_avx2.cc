#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "analysis/prediction_error/simd/lane_likelihood.h"
#include "analysis/prediction_error/simd/lane_linear.h"
#include "analysis/prediction_error/simd/lane_loops.h"
#include "analysis/prediction_error/simd/lane_run.h"
// The loops themselves, translated with this file's flags.
#include "analysis/prediction_error/simd/lane_linear.inc"
#include "analysis/prediction_error/simd/lane_noises.inc"
#include "analysis/prediction_error/simd/lane_run.inc"

namespace contour::diagnosis {

const LaneLoops kAvx2Loops = {RunAll, RunBoth, ColumnsAll, WhitenAll, ProductsAll, LikelihoodAll, kWidth};

}  // namespace contour::diagnosis
