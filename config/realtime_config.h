#pragma once

#include <cstdint>
#include <optional>

#include "core/visit.h"

namespace contour {

/// `realtime:` of a machine file.
struct RealtimeConfig {
  std::int32_t priority = 80;
  std::int32_t cpu = -1;
  bool required = true;
  bool lock_memory = true;
  std::optional<std::int32_t> send_deadline_us;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("priority", priority, Range{1, 99}, "SCHED_FIFO priority of the cycle's thread");
    v.Optional("cpu", cpu, Range{-1, 1023}, "processor the cycle's thread is bound to; -1: not bound");
    v.Optional("required", required,
               "refuse to start when the kernel refuses real time; false: go on without");
    v.Optional("lock_memory", lock_memory, "lock the process into memory (mlockall)");
    v.Optional(
        "send_deadline_us", send_deadline_us, Range{10, 20000},
        "a cycle is late when its frames leave later than this after the grid point; default 20 % of the "
        "cycle");
  }
};

}  // namespace contour
