#include "analysis/prediction_error/keep_memory.h"

#include <malloc.h>

namespace contour::diagnosis {

void KeepMemory() {
  constexpr int kLargest = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kLargest);
  mallopt(M_TRIM_THRESHOLD, kLargest);
  mallopt(M_TOP_PAD, 1 << 25);
}

}  // namespace contour::diagnosis
