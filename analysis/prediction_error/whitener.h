#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace contour::diagnosis {

/// Makes a residual white with unit variance by the inverse of its own spectrum: median over time of Welch
/// segments (a burst does not count), smoothed over frequency, as an autoregressive filter (causal, so that
/// blocks of time stay apart).
class Whitener {
 public:
  Whitener() = default;
  /// `valid`: rows that count; others are 0 in `residual`.
  Whitener(std::span<const double> residual, const std::vector<std::uint8_t>& valid);

  /// Prediction error filter over its own standard deviation.
  const std::vector<double>& taps() const { return taps_; }

 private:
  std::vector<double> taps_ = {1.0};
};

}  // namespace contour::diagnosis
