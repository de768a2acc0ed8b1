#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace contour {

/// Times up to 4 ms in classes of 1 us, for percentiles without keeping every value.
class TimingHistogram {
 public:
  void Add(std::int64_t time_ns) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] double max_us() const noexcept { return static_cast<double>(max_ns_) * 1e-3; }
  /// Upper edge of the class that holds the given share (0..1) of the values, never above max_us(); 0 when
  /// empty. Values beyond the last class are only known as the maximum.
  [[nodiscard]] double Percentile_us(double share) const noexcept;

 private:
  static constexpr std::size_t kClasses = 4000;
  std::array<std::uint64_t, kClasses + 1> counts_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

/// What status shows of a histogram.
struct TimingSummary {
  double p50_us = 0.0;
  double p99_us = 0.0;
  double p999_us = 0.0;
  double max_us = 0.0;
};

TimingSummary Summarize(const TimingHistogram& histogram) noexcept;

}  // namespace contour
