#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "core/cycle_record.h"
#include "daemon/telemetry/patience.h"

namespace contour {

/// Cycle records on their way to one client of the control socket. The pump pushes, the socket server pops;
/// neither is the cycle. Bounded: when the client is too slow the newest rows are lost and counted. Where
/// time waits, in lock-step, it waits for the client first.
class RowFeed {
 public:
  /// Half a minute at 1 kHz, some 20 MB: in lock-step a machine runs a program in a second, and a client on a
  /// busy host needs a while to read it.
  static constexpr std::size_t kDefaultCapacity = 32768;

  explicit RowFeed(std::size_t capacity = kDefaultCapacity) : capacity_(capacity) {}

  /// Keeps the record and the timing of the cycle, not its frames and path points. A row is an encoded
  /// contour_lcm::cycle_entry (see drivers/lcm/cycle_messages.h).
  /// It waits for room as long as there is patience; then not again until the client has taken half of what
  /// waits for it: one that takes a row now and then would hold the machine for good.
  void Push(const CycleEntry& entry, Patience& patience);
  void Push(const CycleEntry& entry) {
    Patience none;
    Push(entry, none);
  }
  std::optional<std::string> Pop();
  /// Nobody pops any more: Push() waits for nothing.
  void End();

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::uint64_t lost() const;
  /// Rows are lost, and go on being lost until the client has caught up.
  [[nodiscard]] bool behind() const;

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable popped_;
  std::deque<std::string> rows_;
  bool ended_ = false;
  bool behind_ = false;
  std::uint64_t lost_ = 0;
};

}  // namespace contour
