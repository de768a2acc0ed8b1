#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "core/cycle_record.h"
#include "daemon/rt/spsc_ring.h"

namespace contour {

/// What an operator must learn whatever becomes of the telemetry: the newest record and the answers to
/// requests. The loop writes it in each cycle, without waiting; one reader at a time takes from it.
class AnswerBoard {
 public:
  AnswerBoard() : answers_(kAnswers) {}

  /// Real-time side: every record, in order.
  void Post(const CycleRecord& record) noexcept {
    // An answer that finds no room is tried again with the next record, which holds the same one.
    if (record.acknowledged != answered_ && answers_.Push(record)) answered_ = record.acknowledged;
    slots_[writing_] = record;
    writing_ = middle_.exchange(writing_ | kNew, std::memory_order_acq_rel) & kSlot;
  }

  /// Reader's side. The newest record; stays as it is until the next call.
  [[nodiscard]] const CycleRecord& Newest() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kNew) != 0)
      reading_ = middle_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
    return slots_[reading_];
  }
  /// The oldest answer not yet taken: the record that it came in.
  bool TakeAnswer(CycleRecord& answer) noexcept { return answers_.Pop(answer); }

 private:
  /// More than there are requests under way at any time.
  static constexpr std::size_t kAnswers = 64;
  static constexpr std::uint32_t kSlot = 3;
  static constexpr std::uint32_t kNew = 4;

  // Three places: one being written, one being read, and the one that changes hands.
  std::array<CycleRecord, 3> slots_{};
  std::atomic<std::uint32_t> middle_{1};
  std::uint32_t writing_ = 0;
  std::uint32_t reading_ = 2;
  SpscRing<CycleRecord> answers_;
  std::uint32_t answered_ = 0;
};

}  // namespace contour
