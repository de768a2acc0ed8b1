#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "drivers/lcm/publisher_stats.h"
#include "drivers/lcm/telemetry_encoder.h"

namespace lcm {
class LCM;
}

namespace contour {

/// Sends messages over LCM. A machine without a route for multicast must still run: what cannot be sent is
/// counted, and a provider that could not be opened is tried again every few seconds. Events come from one
/// thread (the pump); stats() may be called from any.
class LcmPublisher final : public TelemetrySink {
 public:
  explicit LcmPublisher(std::string url);
  ~LcmPublisher() override;
  LcmPublisher(const LcmPublisher&) = delete;
  LcmPublisher& operator=(const LcmPublisher&) = delete;

  void OnEvent(const TelemetryEvent& event) noexcept override;
  [[nodiscard]] PublisherStats stats() const;

 private:
  [[nodiscard]] bool Open();
  void Fail(const std::string& what);

  const std::string url_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::chrono::steady_clock::time_point next_attempt_{};
  std::chrono::seconds reopen_after_{0};
  mutable std::mutex mutex_;  // guards stats_
  PublisherStats stats_;
};

}  // namespace contour
