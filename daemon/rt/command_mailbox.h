#pragma once

#include <atomic>
#include <cstdint>

#include "core/cycle_input.h"
#include "daemon/rt/spsc_ring.h"

namespace contour {

class ContourController;

/// The door into the real-time side. Requests come one per cycle, in sequence, and are acknowledged in the
/// cycle record; a stop overtakes them, is latched and is never overwritten; path points come through a
/// bounded queue of their own. One writer thread for requests, one for path points; any thread may ask for a
/// stop.
class CommandMailbox {
 public:
  CommandMailbox(std::size_t requests, std::size_t path_points) : requests_(requests), path_(path_points) {}

  /// Writer's side. The sequence number to wait for in CycleRecord::acknowledged; 0 when the mailbox is full.
  std::uint32_t Post(RequestKind kind, std::uint32_t program_id = 0) noexcept {
    const std::uint32_t sequence = NextSequence();
    return requests_.Push({kind, sequence, program_id}) ? sequence : 0;
  }
  /// Any thread, also a signal handler: only atomics. Stop and terminate stay until the cycle has taken them.
  std::uint32_t PostStop() noexcept {
    const std::uint32_t sequence = NextSequence();
    stop_.store(sequence, std::memory_order_release);
    return sequence;
  }
  std::uint32_t PostTerminate() noexcept {
    const std::uint32_t sequence = NextSequence();
    terminate_.store(sequence, std::memory_order_release);
    return sequence;
  }
  /// A request that nobody waits for any more is not carried out, if the cycle has not taken it yet.
  void Withdraw(std::uint32_t sequence) noexcept { withdrawn_.store(sequence, std::memory_order_release); }
  /// Other gains: the controller to take, until the request is acknowledged; the one in use comes back in it.
  std::uint32_t PostTune(ContourController& next, std::uint32_t change) noexcept {
    next_controller_.store(&next, std::memory_order_release);
    return Post(RequestKind::kTune, change);
  }
  bool PushPathPoint(const PathPoint& point) noexcept { return path_.Push(point); }
  /// Whether more points of the program are to come; lock-step time waits for them instead of running dry.
  void SetPathSupply(bool more_to_come) noexcept {
    more_to_come_.store(more_to_come, std::memory_order_release);
  }
  [[nodiscard]] bool more_path_to_come() const noexcept {
    return more_to_come_.load(std::memory_order_acquire);
  }
  [[nodiscard]] std::size_t path_points_waiting() const noexcept { return path_.size(); }
  [[nodiscard]] std::size_t path_capacity() const noexcept { return path_.capacity(); }

  /// Real-time side: at most one request a cycle, terminate before stop before the rest (which may be left
  /// for later).
  Request TakeRequest(bool all = true) noexcept {
    if (const std::uint32_t s = terminate_.exchange(0, std::memory_order_acq_rel); s != 0)
      return {RequestKind::kTerminate, s, 0};
    if (const std::uint32_t s = stop_.exchange(0, std::memory_order_acq_rel); s != 0)
      return {RequestKind::kStop, s, 0};
    Request request;
    while (all && requests_.Pop(request)) {
      if (request.sequence > withdrawn_.load(std::memory_order_acquire)) return request;
      request = {};
    }
    return request;
  }
  /// True when TakeRequest would give something.
  [[nodiscard]] bool request_waiting() const noexcept {
    return requests_.size() != 0 || stop_.load(std::memory_order_acquire) != 0 ||
           terminate_.load(std::memory_order_acquire) != 0;
  }
  /// With a request of kind kTune.
  ContourController* TakeController() noexcept {
    return next_controller_.exchange(nullptr, std::memory_order_acq_rel);
  }
  bool TakePathPoint(PathPoint& point) noexcept { return path_.Pop(point); }

 private:
  std::uint32_t NextSequence() noexcept { return 1 + sequence_.fetch_add(1, std::memory_order_relaxed); }

  SpscRing<Request> requests_;
  SpscRing<PathPoint> path_;
  std::atomic<std::uint32_t> sequence_{0};
  std::atomic<std::uint32_t> stop_{0};
  std::atomic<std::uint32_t> terminate_{0};
  std::atomic<std::uint32_t> withdrawn_{0};
  std::atomic<ContourController*> next_controller_{nullptr};
  std::atomic<bool> more_to_come_{false};
};

}  // namespace contour
