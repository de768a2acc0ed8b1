#pragma once

#include <cstdint>
#include <optional>

#include "drivers/modbus/io_config.h"

namespace contour {

/// Decides when the lubrication pump runs. Travel and time in motion are totals since the start; time is
/// handed in.
class Lubrication {
 public:
  explicit Lubrication(const LubricationConfig& config) : config_(config) {}

  /// Whether the coil shall be on now.
  bool Update(double travel_m, double moving_s, std::int64_t now_ns) noexcept {
    if (Due(travel_m, moving_s)) {
      last_travel_m_ = travel_m;
      last_moving_s_ = moving_s;
      off_at_ns_ = now_ns + static_cast<std::int64_t>(config_.pulse_s * 1e9);
      ++pulses_;
    }
    return off_at_ns_ && now_ns < *off_at_ns_;
  }

  [[nodiscard]] std::uint64_t pulses() const noexcept { return pulses_; }

 private:
  [[nodiscard]] bool Due(double travel_m, double moving_s) const noexcept {
    const bool by_travel =
        config_.every_travel_m > 0.0 && travel_m - last_travel_m_ >= config_.every_travel_m;
    const bool by_time = config_.every_moving_s > 0.0 && moving_s - last_moving_s_ >= config_.every_moving_s;
    return by_travel || by_time;
  }

  const LubricationConfig config_;
  double last_travel_m_ = 0.0;
  double last_moving_s_ = 0.0;
  std::optional<std::int64_t> off_at_ns_;
  std::uint64_t pulses_ = 0;
};

}  // namespace contour
