#include "daemon/telemetry/row_feed.h"

#include <chrono>
#include <utility>

#include "drivers/lcm/cycle_messages.h"

namespace contour {

void RowFeed::Push(const CycleEntry& entry, Patience& patience) {
  contour_lcm::cycle_entry message;
  ToMessage(entry, message);
  message.num_sent = message.input.num_frames = message.input.num_path_points = 0;
  message.sent.clear();
  message.input.frames.clear();
  message.input.path.clear();
  std::string row = Encode(message);
  std::unique_lock lock(mutex_);
  const auto room = [&] { return rows_.size() < capacity_ || ended_; };
  if (!behind_ && !room() && patience.ForOne() > Patience::Duration::zero()) {
    const auto began = std::chrono::steady_clock::now();
    popped_.wait_for(lock, patience.ForOne(), room);
    patience.Use(std::chrono::steady_clock::now() - began);
  }
  if (behind_ || rows_.size() >= capacity_) {
    behind_ = true;
    ++lost_;
    return;
  }
  rows_.push_back(std::move(row));
}

std::optional<std::string> RowFeed::Pop() {
  const std::lock_guard lock(mutex_);
  if (rows_.empty()) return std::nullopt;
  std::string row = std::move(rows_.front());
  rows_.pop_front();
  behind_ = behind_ && rows_.size() > capacity_ / 2;
  popped_.notify_one();
  return row;
}

void RowFeed::End() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  popped_.notify_one();
}

std::size_t RowFeed::size() const {
  const std::lock_guard lock(mutex_);
  return rows_.size();
}

std::uint64_t RowFeed::lost() const {
  const std::lock_guard lock(mutex_);
  return lost_;
}

bool RowFeed::behind() const {
  const std::lock_guard lock(mutex_);
  return behind_;
}

}  // namespace contour
