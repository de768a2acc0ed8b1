#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace contour::bench {

template <class Call>
double MicrosecondsOf(const Call& call) {
  const auto begin = std::chrono::steady_clock::now();
  call();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  return 1e6 * taken.count();
}

inline double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Times single calls and reports their median and 99.9 % value in microseconds beside the mean. For a
/// benchmark with UseManualTime. Two readings of the clock (some 40 ns) are in each.
class Latencies {
 public:
  explicit Latencies(benchmark::State& state) : state_(state) { times_us_.reserve(1 << 20); }

  template <class Call>
  void Time(const Call& call) {
    const double taken_us = MicrosecondsOf(call);
    state_.SetIterationTime(1e-6 * taken_us);
    times_us_.push_back(taken_us);
  }

  ~Latencies() {
    if (times_us_.empty()) return;
    std::sort(times_us_.begin(), times_us_.end());
    state_.counters["median_us"] = times_us_[times_us_.size() / 2];
    state_.counters["p99.9_us"] = times_us_[times_us_.size() * 999 / 1000];
  }
  Latencies(const Latencies&) = delete;
  Latencies& operator=(const Latencies&) = delete;

 private:
  benchmark::State& state_;
  std::vector<double> times_us_;
};

}  // namespace contour::bench
