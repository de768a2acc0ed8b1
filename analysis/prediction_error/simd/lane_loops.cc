#include "analysis/prediction_error/simd/lane_loops.h"

namespace contour::diagnosis {

bool HasAvx2() { return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; }

bool HasAvx512() {
  return HasAvx2() && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512bw") != 0;
}

const LaneLoops& BestLoops() {
  static const LaneLoops& best = HasAvx512() ? kAvx512Loops : (HasAvx2() ? kAvx2Loops : kBaselineLoops);
  return best;
}

}  // namespace contour::diagnosis
