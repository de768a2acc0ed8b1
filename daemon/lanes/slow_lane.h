#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <thread>

namespace contour {

/// A thread for what may take for ever, such as a disk, a pipe or a network: whoever hands work over never
/// waits for it to be done. What waits is bounded; what does not fit is refused, and the caller counts it.
///
/// Nothing of this can be called back when it is stuck. So each piece of work owns what it works on (by
/// shared_ptr, for one), and at the end a thread that is stuck is left behind, for the process to end without
/// it.
class SlowLane {
 public:
  struct Limits {
    std::size_t max_bytes = 1u << 20;
    /// How long Post() waits for room while the thread gets nothing done; then not again until it does. Only
    /// where time can wait, in lock-step, anything but 0.
    std::chrono::milliseconds patience{0};
  };
  /// `name` is the thread's, 15 characters at most.
  SlowLane(const char* name, Limits limits);
  /// Does not wait for what has not been done.
  ~SlowLane();
  SlowLane(const SlowLane&) = delete;
  SlowLane& operator=(const SlowLane&) = delete;

  /// Work that holds so many bytes, to be done in its turn. False, and it will not be done, when there is no
  /// room; `beyond` is room that other work does not get. Work may throw; that is then its end. Any thread.
  bool Post(std::size_t bytes, std::function<void()> work, std::size_t beyond = 0);

  /// Whether all is done by then. Takes no more work; a thread that is stuck is left behind.
  bool Finish(std::chrono::steady_clock::time_point deadline);

  [[nodiscard]] std::size_t waiting_bytes() const;

 private:
  struct Shared;
  static void Work(const std::shared_ptr<Shared>& shared);

  const Limits limits_;
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace contour
