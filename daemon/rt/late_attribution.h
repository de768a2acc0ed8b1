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

/// What a cycle comes after, and what is known of it besides its own times.
struct CycleSurroundings {
  LateCause before = LateCause::kNone;  ///< cause of the cycle before
  /// By how much that one ran past this one's grid point: the thread had no time to sleep, and began late.
  std::int64_t overrun_ns = 0;
  /// Neither on a CPU, nor ready for one, nor asleep until the grid point.
  std::int64_t waited_ns = 0;
};

/// Whether a cycle was late, and why: the longest of its parts, or what held that part up. A cycle that is
/// late only for the cycle before (grid points were skipped, or it began late because that one ended late)
/// has the same cause. A pure function of the stamps and of what the kernel counted; called after the frames
/// are sent.
LateCause FindLateCause(const CycleTiming& timing, const CycleSurroundings& around,
                        const LatenessLimits& limits) noexcept;

}  // namespace contour
