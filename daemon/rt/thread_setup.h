#pragma once

#include <string>
#include <vector>

namespace contour {

/// What the real-time thread asks of the kernel.
struct ThreadRequest {
  int priority = 80;  ///< SCHED_FIFO
  int cpu = -1;       ///< -1: wherever the kernel likes
  bool lock_memory = true;
  std::size_t stack_prefault_bytes = 512 * 1024;
};

/// Applies the request to the calling thread (memory lock: to the process). Returns what was refused, each a
/// sentence with the limit that refused it and what to change; empty when all was granted.
std::vector<std::string> ApplyThreadRequest(const ThreadRequest& request);

}  // namespace contour
