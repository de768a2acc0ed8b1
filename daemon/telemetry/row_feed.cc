#include "daemon/telemetry/row_feed.h"

#include <utility>

#include "drivers/lcm/cycle_messages.h"

namespace contour {

void RowFeed::Push(const CycleEntry& entry, std::chrono::milliseconds patience) {
  contour_lcm::cycle_entry message;
  ToMessage(entry, message);
  message.num_sent = message.input.num_frames = message.input.num_path_points = 0;
  message.sent.clear();
  message.input.frames.clear();
  message.input.path.clear();
  std::string row = Encode(message);
  std::unique_lock lock(mutex_);
  while (rows_.size() >= capacity_ && !ended_ && !out_of_patience_ && patience.count() > 0) {
    const std::uint64_t before = pops_;
    out_of_patience_ = !popped_.wait_for(lock, patience, [&] { return pops_ != before || ended_; });
  }
  if (rows_.size() >= capacity_) {
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
  ++pops_;
  out_of_patience_ = false;
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

}  // namespace contour
