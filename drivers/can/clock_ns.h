#pragma once

#include <cstdint>
#include <ctime>

namespace contour {

/// What a clock of the kernel reads, ns: CLOCK_MONOTONIC for grid points and stamps of frames. Nothing below
/// Cycle::Step may call it.
inline std::int64_t ClockNow_ns(clockid_t clock = CLOCK_MONOTONIC) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

}  // namespace contour
