#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/cycle_record.h"

namespace contour {

/// The newest answers of the cycle, each with the record it came in. A record holds one answer only, and a
/// stop may be answered in the cycle after another request: who waits for the earlier answer would never see
/// it.
class AnswerBook {
 public:
  /// Every record, in order.
  void Add(const CycleRecord& record) noexcept {
    if (record.acknowledged == newest_) return;
    newest_ = record.acknowledged;
    answers_[next_] = record;
    next_ = (next_ + 1) % answers_.size();
  }
  /// The record that answered the request `sequence` (from 1), while it is one of the newest.
  [[nodiscard]] std::optional<CycleRecord> Find(std::uint32_t sequence) const noexcept {
    for (const CycleRecord& answer : answers_)
      if (answer.acknowledged == sequence) return answer;
    return std::nullopt;
  }

 private:
  std::array<CycleRecord, 16> answers_{};
  std::size_t next_ = 0;
  std::uint32_t newest_ = 0;
};

}  // namespace contour
