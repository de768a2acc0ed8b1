#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace contour {

/// What one poll found, at the time it was asked for.
struct IoSample {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC before the request went out
  bool emergency_stop_closed = false;
  bool enable_chain_closed = false;
  std::int16_t temperature_counts = 0;
  bool taken = false;  ///< false: there has been no poll
};

/// The newest sample, handed from the I/O thread to the real-time loop. All of it fits one atomic word, so
/// neither side ever waits or retries. Time is kept to 0.1 ms, rounded down: age errs on the old side.
class IoSnapshot {
 public:
  void Store(const IoSample& s) noexcept {
    const std::uint64_t ticks = static_cast<std::uint64_t>(std::max<std::int64_t>(s.time_ns, 0) / kTick_ns);
    word_.store(ticks << kTimeShift | std::uint64_t{s.taken} << 18 |
                    std::uint64_t{s.emergency_stop_closed} << 17 |
                    std::uint64_t{s.enable_chain_closed} << 16 |
                    std::uint64_t{static_cast<std::uint16_t>(s.temperature_counts)},
                std::memory_order_release);
  }

  [[nodiscard]] IoSample Load() const noexcept {
    const std::uint64_t word = word_.load(std::memory_order_acquire);
    IoSample s;
    s.time_ns = static_cast<std::int64_t>(word >> kTimeShift) * kTick_ns;
    s.taken = (word >> 18 & 1u) != 0;
    s.emergency_stop_closed = (word >> 17 & 1u) != 0;
    s.enable_chain_closed = (word >> 16 & 1u) != 0;
    s.temperature_counts = static_cast<std::int16_t>(word & 0xFFFFu);
    return s;
  }

 private:
  static constexpr std::int64_t kTick_ns = 100'000;
  static constexpr int kTimeShift = 19;  // leaves 45 bits: 111 years
  std::atomic<std::uint64_t> word_{0};
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};

}  // namespace contour
