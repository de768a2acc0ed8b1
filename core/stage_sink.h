#pragma once

#include <cstdint>

#include "core/nonblocking.h"

namespace contour {

/// Parts of a cycle, for stamps.
enum class CycleStage : std::uint8_t {
  kEstimated,  ///< frames decoded, estimators updated
  kDecided,    ///< machine state, planner and controller
};

/// Is told how far a cycle has come. Whoever takes the time does it here, outside: the cycle itself never
/// sees a clock, and computes the same with no sink at all.
class StageSink {
 public:
  virtual ~StageSink() = default;
  virtual void Passed(CycleStage stage) noexcept CONTOUR_NONBLOCKING = 0;
};

}  // namespace contour
