#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/cycle_input.h"
#include "daemon/rt/path_progress.h"
#include "daemon/rt/spsc_ring.h"

namespace contour {

class ContourController;

/// What became of a request.
enum class RequestFate : std::uint8_t {
  kWaiting = 0,    ///< the cycle has not taken it
  kTaken = 1,      ///< it has, and will answer
  kWithdrawn = 2,  ///< it will not, because nobody wants it any more
  kVoid = 3,       ///< it will not, because a stop came
};

/// The door into the real-time side. Requests come one per cycle, in sequence, and are acknowledged in the
/// cycle record; a stop overtakes them, is latched and is never overwritten, and what was to set the axes in
/// motion before it is void; path points come through a bounded queue of their own. One writer thread for
/// requests, one for path points; any thread may ask for a stop or withdraw.
class CommandMailbox {
 public:
  CommandMailbox(std::size_t requests, std::size_t path_points)
      : requests_(requests),
        path_(path_points),
        claims_(new std::atomic<std::uint64_t>[requests_.capacity()]()) {}

  /// Writer's side. The sequence number to wait for in CycleRecord::acknowledged; 0 when the mailbox is full.
  /// Some places are kept for those who want the torque off.
  std::uint32_t Post(RequestKind kind, std::uint32_t program_id = 0) noexcept {
    const std::size_t kept = kind == RequestKind::kDisable ? 0 : requests_.capacity() / 4;
    if (requests_.size() + kept >= requests_.capacity()) return 0;
    const std::uint32_t sequence = NextSequence();
    claims_[posted_++ % requests_.capacity()].store(Claim(sequence, RequestFate::kWaiting),
                                                    std::memory_order_release);
    requests_.Push({kind, sequence, program_id});
    return sequence;
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
  /// A request that nobody waits for any more: true when the cycle will not take it, false when it has.
  bool Withdraw(std::uint32_t sequence) noexcept {
    for (std::size_t i = 0; i < requests_.capacity(); ++i) {
      std::uint64_t waiting = Claim(sequence, RequestFate::kWaiting);
      if (claims_[i].compare_exchange_strong(waiting, Claim(sequence, RequestFate::kWithdrawn),
                                             std::memory_order_acq_rel))
        return true;
    }
    return false;
  }
  /// Of one of the latest requests (not of a stop); kTaken of those that are long gone.
  [[nodiscard]] RequestFate Fate(std::uint32_t sequence) const noexcept {
    for (std::size_t i = 0; i < requests_.capacity(); ++i) {
      const std::uint64_t claim = claims_[i].load(std::memory_order_acquire);
      if (claim >> kFateBits == sequence) return static_cast<RequestFate>(claim & kFateMask);
    }
    return RequestFate::kTaken;
  }
  /// Other gains: the controller to take, until the request is acknowledged; the one in use comes back in it.
  std::uint32_t PostTune(ContourController& next, std::uint32_t change) noexcept {
    next_controller_.store(&next, std::memory_order_release);
    return Post(RequestKind::kTune, change);
  }
  bool PushPathPoint(const PathPoint& point) noexcept { return path_.Push(point); }
  /// All of them at once, or none: the cycle never finds the first without the others.
  bool PushPathPoints(const PathPoint* points, std::size_t count) noexcept {
    return path_.PushAll(points, count);
  }
  /// What has been pushed so far and was not taken yet is not wanted any more.
  void SkipPath() noexcept { skip_.store(path_.pushed(), std::memory_order_release); }
  /// Where the cycle has got to on the path.
  [[nodiscard]] PathProgress path_progress() const noexcept {
    return {earliest_.load(std::memory_order_acquire), end_.load(std::memory_order_acquire),
            law_.load(std::memory_order_acquire), refused_law_.load(std::memory_order_acquire)};
  }
  /// Whether more points of the program are to come; lock-step time waits for them instead of running dry.
  void SetPathSupply(bool more_to_come) noexcept {
    more_to_come_.store(more_to_come, std::memory_order_release);
  }
  [[nodiscard]] bool more_path_to_come() const noexcept {
    return more_to_come_.load(std::memory_order_acquire);
  }
  /// Whether another law of time is being planned; lock-step time waits for it, or every law would come too
  /// late.
  void SetPathPlanning(bool planning) noexcept { planning_.store(planning, std::memory_order_release); }
  [[nodiscard]] bool path_planning() const noexcept { return planning_.load(std::memory_order_acquire); }
  [[nodiscard]] std::size_t path_points_waiting() const noexcept { return path_.size(); }
  [[nodiscard]] std::size_t path_capacity() const noexcept { return path_.capacity(); }

  /// Real-time side: at most one request a cycle, terminate before stop before the rest (which may be left
  /// for later).
  Request TakeRequest(bool all = true) noexcept {
    if (const std::uint32_t s = terminate_.exchange(0, std::memory_order_acq_rel); s != 0)
      return Stopping({RequestKind::kTerminate, s, 0});
    if (const std::uint32_t s = stop_.exchange(0, std::memory_order_acq_rel); s != 0)
      return Stopping({RequestKind::kStop, s, 0});
    while (const Request* front = all ? requests_.Front() : nullptr) {
      const Request request = *front;
      std::uint64_t waiting = Claim(request.sequence, RequestFate::kWaiting);
      const bool is_void = LeadsToMotion(request.kind) && request.sequence < stopped_;
      const RequestFate fate = is_void ? RequestFate::kVoid : RequestFate::kTaken;
      // Before the place is given back, and with it the claim.
      const bool ours = claims_[taken_++ % requests_.capacity()].compare_exchange_strong(
          waiting, Claim(request.sequence, fate), std::memory_order_acq_rel);
      requests_.Release();
      if (ours && !is_void) return request;
    }
    return {};
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
  bool TakePathPoint(PathPoint& point) noexcept {
    path_.ReleaseUntil(skip_.load(std::memory_order_acquire));
    return path_.Pop(point);
  }
  /// Every cycle.
  void TellProgress(const PathProgress& now) noexcept {
    // The end first: a writer that sees the later start sees an end that is no older.
    end_.store(now.end, std::memory_order_release);
    law_.store(now.law, std::memory_order_release);
    refused_law_.store(now.refused_law, std::memory_order_release);
    earliest_.store(now.earliest, std::memory_order_release);
  }

 private:
  static constexpr unsigned kFateBits = 2;
  static constexpr std::uint64_t kFateMask = 3;
  static constexpr std::uint64_t Claim(std::uint32_t sequence, RequestFate fate) noexcept {
    return std::uint64_t{sequence} << kFateBits | static_cast<std::uint64_t>(fate);
  }
  static constexpr bool LeadsToMotion(RequestKind kind) noexcept {
    return kind == RequestKind::kEnable || kind == RequestKind::kRun;
  }
  Request Stopping(Request request) noexcept {
    stopped_ = std::max(stopped_, request.sequence);
    return request;
  }
  std::uint32_t NextSequence() noexcept { return 1 + sequence_.fetch_add(1, std::memory_order_relaxed); }

  SpscRing<Request> requests_;
  SpscRing<PathPoint> path_;
  /// Who has each place of requests_: decided by one exchange, so that a request is either carried out and
  /// answered, or neither.
  std::unique_ptr<std::atomic<std::uint64_t>[]> claims_;
  std::size_t posted_ = 0;     ///< the writer's
  std::size_t taken_ = 0;      ///< the real-time side's, as is the next
  std::uint32_t stopped_ = 0;  ///< sequence of the newest stop taken
  std::atomic<std::uint32_t> sequence_{0};
  std::atomic<std::uint32_t> stop_{0};
  std::atomic<std::uint32_t> terminate_{0};
  std::atomic<ContourController*> next_controller_{nullptr};
  std::atomic<bool> more_to_come_{false};
  std::atomic<bool> planning_{false};
  std::atomic<std::size_t> skip_{0};  ///< so many path points are not wanted
  // PathProgress:
  std::atomic<std::uint64_t> earliest_{PathProgress::kNowhere};
  std::atomic<std::uint64_t> end_{0};
  std::atomic<std::uint32_t> law_{0};
  std::atomic<std::uint32_t> refused_law_{0};
};

}  // namespace contour
