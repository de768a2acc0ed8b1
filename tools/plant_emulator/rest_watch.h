#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tools/plant_emulator/emulator_config.h"

namespace contour::plant {

/// Tells when an axis rests: its target has stayed where it is, and the readings near it, for some time. At
/// the first tick at which either goes away it rests no more.
class RestWatch {
 public:
  RestWatch(const EmulatedCascadeConfig& config, double tick_s, double count_m) noexcept
      : window_m_((config.rest_window_counts + kHalf) * count_m),
        target_window_m_((1.0 + kHalf) * count_m),
        ticks_(static_cast<std::int64_t>(std::ceil(1e-3 * config.rest_delay_ms / tick_s))),
        watches_(config.rest_window_counts > 0) {}

  void Reset() noexcept { still_ = 0; }
  bool Rests(double target_m, double position_m) noexcept {
    if (!watches_) return false;
    const bool moved = std::fabs(target_m - anchor_m_) > target_window_m_;
    if (moved) anchor_m_ = target_m;
    if (moved || std::fabs(target_m - position_m) > window_m_)
      still_ = 0;
    else
      still_ = std::min(still_ + 1, ticks_);
    return still_ >= ticks_;
  }

 private:
  static constexpr double kHalf = 0.5;  // whole counts are compared

  double window_m_;
  double target_window_m_;
  std::int64_t ticks_;
  bool watches_;
  double anchor_m_ = 0.0;
  std::int64_t still_ = 0;
};

}  // namespace contour::plant
