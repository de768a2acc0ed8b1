#pragma once

#include <cstdint>

#include "core/cycle_record.h"

namespace contour {

/// What attribution needs to know besides the stamps of a cycle.
struct LatenessLimits {
  std::int64_t send_deadline_ns = 200'000;
  /// How long the kernel's real-time throttling stops a thread at a time; 0: there is none.
  std::int64_t throttle_ns = 0;
};

/// Whether a cycle was late, and why: the longest of its parts, or what held that part up. `before` is the
/// cause of the cycle before; a cycle that is late only for the grid points skipped before it has the same.
/// A pure function of the stamps and of what the kernel counted; called after the frames are sent.
LateCause FindLateCause(const CycleTiming& timing, LateCause before, const LatenessLimits& limits) noexcept;

}  // namespace contour
