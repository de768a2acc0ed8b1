#pragma once

#include <atomic>
#include <cstdint>

#include "core/cycle_record.h"
#include "daemon/rt/answer_board.h"
#include "daemon/rt/spsc_ring.h"

namespace contour {

/// The door out of the real-time side: one entry per cycle. When the reader falls behind, entries are dropped
/// and counted, the cycle never waits. The newest record and the answers to requests pass it beside the
/// queue, on a board: operators get them whatever becomes of the entries.
class TelemetryQueue {
 public:
  explicit TelemetryQueue(std::size_t capacity) : ring_(capacity) {}

  /// Real-time side. Never null: when the queue is full the entry is written to a spare place and counted as
  /// dropped.
  [[nodiscard]] CycleEntry* Reserve() noexcept {
    CycleEntry* slot = ring_.Reserve();
    reserved_ = slot != nullptr;
    entry_ = reserved_ ? slot : &spare_;
    return entry_;
  }
  void Publish() noexcept {
    board_.Post(entry_->output.record);
    if (reserved_) {
      ring_.Publish();
    } else {
      dropped_.fetch_add(1, std::memory_order_relaxed);
    }
  }

  /// Reader's side.
  [[nodiscard]] CycleEntry* Front() noexcept { return ring_.Front(); }
  void Release() noexcept { ring_.Release(); }
  [[nodiscard]] std::size_t capacity() const noexcept { return ring_.capacity(); }
  [[nodiscard]] std::size_t size() const noexcept { return ring_.size(); }
  [[nodiscard]] AnswerBoard& board() noexcept { return board_; }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  SpscRing<CycleEntry> ring_;
  CycleEntry spare_;
  CycleEntry* entry_ = &spare_;
  AnswerBoard board_;
  bool reserved_ = false;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace contour
