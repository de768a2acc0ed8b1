#include "daemon/telemetry/timing_histogram.h"

#include <algorithm>
#include <cmath>

namespace contour {

void TimingHistogram::Add(std::int64_t time_ns) noexcept {
  const std::int64_t class_us = std::max<std::int64_t>(time_ns, 0) / 1000;
  counts_[std::min(static_cast<std::size_t>(class_us), kClasses)]++;
  max_ns_ = count_ == 0 ? time_ns : std::max(max_ns_, time_ns);
  ++count_;
}

double TimingHistogram::Percentile_us(double share) const noexcept {
  const double wanted = std::ceil(share * static_cast<double>(count_));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < kClasses; ++i) {
    seen += counts_[i];
    if (seen != 0 && static_cast<double>(seen) >= wanted)
      return std::min(static_cast<double>(i + 1), max_us());
  }
  return max_us();
}

TimingSummary Summarize(const TimingHistogram& histogram) noexcept {
  return {histogram.Percentile_us(0.5), histogram.Percentile_us(0.99), histogram.Percentile_us(0.999),
          histogram.max_us()};
}

}  // namespace contour
