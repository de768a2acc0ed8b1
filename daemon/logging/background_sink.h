#pragma once

#include <spdlog/details/log_msg_buffer.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/sink.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "daemon/lanes/slow_lane.h"

namespace contour {

/// Hands lines to a logger in a thread of its own, so that nobody waits for a pipe or a disk. What finds no
/// room is lost and counted.
class BackgroundSink final : public spdlog::sinks::sink {
 public:
  BackgroundSink(std::shared_ptr<spdlog::logger> to, std::size_t max_bytes)
      : to_(std::move(to)), lane_("contour-text", {max_bytes, {}}) {}

  void log(const spdlog::details::log_msg& message) override {
    const std::uint64_t lost = lost_.exchange(0);
    auto line = std::make_shared<const spdlog::details::log_msg_buffer>(message);
    const bool taken = lane_.Post(message.payload.size() + sizeof(*line), [to = to_, line, lost] {
      if (lost != 0) to->warn("{} messages were lost: nobody took them", lost);
      for (const auto& each : to->sinks())
        if (each->should_log(line->level)) each->log(*line);
      // All of them, at once: whoever waits for a line need not wait for a flush as well.
      for (const auto& each : to->sinks()) each->flush();
    });
    if (!taken) lost_ += lost + 1;
  }
  /// Each line is flushed as it is written.
  void flush() override {}
  void set_pattern(const std::string& pattern) override { to_->set_pattern(pattern); }
  void set_formatter(std::unique_ptr<spdlog::formatter> formatter) override {
    to_->set_formatter(std::move(formatter));
  }

  bool Finish(std::chrono::steady_clock::time_point deadline) { return lane_.Finish(deadline); }

 private:
  std::shared_ptr<spdlog::logger> to_;
  std::atomic<std::uint64_t> lost_{0};
  SlowLane lane_;
};

}  // namespace contour
