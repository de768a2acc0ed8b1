#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "drivers/can/bus_node.h"

namespace contour::faults {

/// Somebody on the bus who should not be there: sends frames, each at its own period.
class Intruder final : public BusNode {
 public:
  /// `count` times (-1: for good), first `first_ns` after the next thing that happens on the bus.
  void Begin(const CanFrame& frame, std::int64_t period_ns, int count, std::int64_t first_ns = 0) {
    jobs_.push_back({frame, period_ns, count, std::max(now_ns_ + first_ns, now_ns_)});
  }
  void End() { jobs_.clear(); }
  /// The bus's time, which a node only hears of.
  void SetTime(std::int64_t now_ns) noexcept { now_ns_ = std::max(now_ns_, now_ns); }

  void OnFrame(const CanFrame&, std::int64_t time_ns, PendingFrames&) noexcept override { SetTime(time_ns); }
  void OnTimer(std::int64_t time_ns, PendingFrames& out) noexcept override {
    SetTime(time_ns);
    for (Job& j : jobs_) {
      if (j.count == 0 || j.next_ns > time_ns || out.size() == out.capacity()) continue;
      out.push_back({j.frame, time_ns});
      j.next_ns += j.period_ns;
      if (j.count > 0) --j.count;
    }
  }
  [[nodiscard]] std::int64_t NextTimer() const noexcept override {
    std::int64_t next = kNever;
    for (const Job& j : jobs_)
      if (j.count != 0) next = std::min(next, j.next_ns);
    return next;
  }

 private:
  struct Job {
    CanFrame frame;
    std::int64_t period_ns = 0;
    int count = 0;
    std::int64_t next_ns = 0;
  };
  std::vector<Job> jobs_;
  std::int64_t now_ns_ = 0;
};

}  // namespace contour::faults
