#pragma once

#include <cstdint>

namespace contour {

/// What the kernel has counted of the calling thread since the last call.
struct ThreadCounts {
  std::uint32_t page_faults = 0;
  std::uint32_t involuntary_switches = 0;
  std::uint32_t voluntary_switches = 0;
};

/// Reads the kernel's accounting of one thread. Construct, and call everything, in that thread. No memory is
/// taken after construction.
class ThreadAccounting {
 public:
  ThreadAccounting() noexcept;
  ~ThreadAccounting();
  ThreadAccounting(const ThreadAccounting&) = delete;
  ThreadAccounting& operator=(const ThreadAccounting&) = delete;

  /// One system call.
  ThreadCounts Read() noexcept;
  /// Time that the thread was ready to run and did not run, since the last call; 0 where the kernel does not
  /// tell. One system call.
  std::int64_t RunDelay_ns() noexcept;
  /// Time that the thread did not run, for whatever reason, since the last call. One system call.
  std::int64_t OffCpu_ns() noexcept;

 private:
  int schedstat_ = -1;
  std::uint64_t faults_ = 0;
  std::uint64_t involuntary_ = 0;
  std::uint64_t voluntary_ = 0;
  std::int64_t run_delay_ns_ = 0;
  std::int64_t off_cpu_ns_ = 0;
};

/// How long the kernel's real-time throttling stops threads at a time; 0 when it is off.
std::int64_t ThrottleTime_ns() noexcept;

}  // namespace contour
