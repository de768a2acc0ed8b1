#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "daemon/lanes/slow_lane.h"
#include "drivers/lcm/lcm_publisher.h"

namespace contour {

/// LCM from a thread of its own: a network that takes nothing holds nobody up. Messages that find no room are
/// failures, and counted.
class BackgroundPublisher final : public TelemetrySink {
 public:
  BackgroundPublisher(const std::string& url, std::chrono::milliseconds patience)
      : publisher_(std::make_shared<LcmPublisher>(url)), lane_("contour-lcm", {kMaxBytes, patience}) {}

  void OnEvent(const TelemetryEvent& event) noexcept override {
    bool taken = false;
    try {
      auto work = [publisher = publisher_, channel = std::string(event.channel),
                   bytes = std::string(event.bytes), time_ns = event.grid_time_ns, cycles = event.cycles] {
        publisher->OnEvent({channel, bytes, time_ns, cycles});
      };
      taken = lane_.Post(event.channel.size() + event.bytes.size(), std::move(work));
    } catch (const std::exception&) {
      // No memory: lost like what finds no room.
    }
    if (!taken) lost_.fetch_add(1, std::memory_order_relaxed);
  }
  bool Finish(std::chrono::steady_clock::time_point deadline) { return lane_.Finish(deadline); }

  [[nodiscard]] PublisherStats stats() const {
    PublisherStats stats = publisher_->stats();
    const std::uint64_t lost = lost_.load(std::memory_order_relaxed);
    stats.failures += lost;
    if (lost != 0 && stats.last_error.empty()) stats.last_error = "LCM took nothing for too long";
    return stats;
  }

 private:
  static constexpr std::size_t kMaxBytes = 4u << 20;
  std::shared_ptr<LcmPublisher> publisher_;
  std::atomic<std::uint64_t> lost_{0};
  SlowLane lane_;
};

}  // namespace contour
