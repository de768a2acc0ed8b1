#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "core/cycle_record.h"
#include "daemon/rt/answer_board.h"
#include "daemon/telemetry/answer_book.h"

namespace contour {

/// The answer board for any number of readers. The lock is theirs alone and held for a copy: neither the
/// cycle nor the pump nor anything that may be stuck ever takes it.
class CycleAnswers {
 public:
  explicit CycleAnswers(AnswerBoard& board) : board_(board) {}

  /// The newest record.
  [[nodiscard]] CycleRecord record() {
    const std::lock_guard lock(mutex_);
    return board_.Newest();
  }
  /// The record that acknowledged a request. Cheap enough to poll while waiting for it.
  [[nodiscard]] std::optional<CycleRecord> answer(std::uint32_t sequence) {
    const std::lock_guard lock(mutex_);
    CycleRecord record;
    while (board_.TakeAnswer(record)) book_.Add(record);
    return book_.Find(sequence);
  }

 private:
  AnswerBoard& board_;
  std::mutex mutex_;  // guards the reader's side of board_, and book_
  AnswerBook book_;
};

}  // namespace contour
