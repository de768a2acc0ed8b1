#include "daemon/rt/late_attribution.h"

#include <array>

namespace contour {
namespace {

struct Part {
  LateCause cause;
  std::int64_t length_ns;
};

/// The longest part of the time from the grid point to the frames sent.
Part Longest(const CycleTiming& t, std::int64_t overrun_ns) noexcept {
  const std::array<Part, 6> parts{{
      {LateCause::kAfterSend, overrun_ns},
      {LateCause::kWakeUp, t.wakeup_late_ns - overrun_ns},
      {LateCause::kReceive, t.received_ns - t.wakeup_late_ns},
      {LateCause::kEstimate, t.estimated_ns - t.received_ns},
      {LateCause::kControl, t.stepped_ns - t.estimated_ns},
      {LateCause::kSend, t.sent_ns - t.stepped_ns},
  }};
  Part longest = parts[0];
  for (const Part& part : parts)
    if (part.length_ns > longest.length_ns) longest = part;
  return longest;
}

LateCause WhatHeldUp(const Part& part, const CycleTiming& t, std::int64_t waited_ns,
                     const LatenessLimits& limits) noexcept {
  // Ready to run and not running: somebody else had the CPU, or nobody was allowed to. Time of this kind
  // that is more than half of the part explains it.
  if (t.run_delay_ns > part.length_ns / 2) {
    const bool as_long = limits.throttle_ns > 0 && part.length_ns > limits.throttle_ns * 8 / 10 &&
                         part.length_ns < limits.throttle_ns * 12 / 10;
    return as_long ? LateCause::kThrottled : LateCause::kPreempted;
  }
  // A thread that sleeps touches no memory. But the code it wakes up into may be gone: the thread is woken in
  // time, faults before it can look at the clock, and gives up the CPU until the page is there.
  if (t.page_faults != 0 && (part.cause != LateCause::kWakeUp || t.voluntary_switches != 0))
    return LateCause::kPageFault;
  // A short wait for a lock is no explanation of a long part.
  if (t.voluntary_switches != 0 && waited_ns > part.length_ns / 2) return LateCause::kStopped;
  // Where the kernel tells how long the thread waited, a short wait is no explanation.
  const bool unknown_wait = t.run_delay_ns == 0;
  if (unknown_wait && t.involuntary_switches != 0 && part.cause != LateCause::kWakeUp)
    return LateCause::kPreempted;
  return part.cause;
}

}  // namespace

LateCause FindLateCause(const CycleTiming& t, const CycleSurroundings& around,
                        const LatenessLimits& limits) noexcept {
  if (t.sent_ns > limits.send_deadline_ns) {
    const Part longest = Longest(t, around.overrun_ns);
    if (longest.cause != LateCause::kAfterSend) return WhatHeldUp(longest, t, around.waited_ns, limits);
  } else if (t.skipped_grid_points == 0) {
    return LateCause::kNone;
  }
  if (around.before != LateCause::kNone) return around.before;
  return WhatHeldUp({LateCause::kAfterSend, t.after_send_ns}, t, around.waited_ns, limits);
}

}  // namespace contour
