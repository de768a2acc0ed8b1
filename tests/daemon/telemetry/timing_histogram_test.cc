#include "daemon/telemetry/timing_histogram.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

TEST(TimingHistogramTest, PercentilesAreUpperEdgesOfTheirMicrosecond) {
  TimingHistogram h;
  for (std::int64_t us = 0; us < 100; ++us) h.Add(us * 1000 + 500);
  EXPECT_EQ(h.Percentile_us(0.5), 50.0);
  EXPECT_EQ(h.Percentile_us(0.99), 99.0);
  EXPECT_EQ(h.max_us(), 99.5);
  EXPECT_EQ(h.Percentile_us(1.0), 99.5);
  EXPECT_EQ(h.count(), 100u);
}

TEST(TimingHistogramTest, KeepsTheMaximumOfTimesBeyondItsClasses) {
  TimingHistogram h;
  h.Add(1000);
  h.Add(25'000'000);
  EXPECT_EQ(h.max_us(), 25000.0);
  EXPECT_EQ(Summarize(h).p999_us, 25000.0);
  EXPECT_EQ(Summarize(h).p50_us, 2.0);
}

TEST(TimingHistogramTest, EmptyIsZero) {
  EXPECT_EQ(Summarize(TimingHistogram{}).p99_us, 0.0);
  EXPECT_EQ(TimingHistogram{}.max_us(), 0.0);
}

TEST(TimingHistogramTest, TimesBeforeTheGridPointCountAsOnTime) {
  TimingHistogram h;
  h.Add(-3000);
  EXPECT_EQ(h.max_us(), -3.0);
  EXPECT_EQ(h.count(), 1u);
}

}  // namespace
}  // namespace contour
