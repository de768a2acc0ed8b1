#include "daemon/telemetry/cycle_health.h"

#include <cstdio>

namespace contour {
namespace {

/// The first cycles touch memory for the first time.
constexpr std::uint64_t kWarmUpCycles = 1000;
constexpr std::int64_t kQuiet_ns = 1'000'000'000;

}  // namespace

void CycleHealth::Add(const CycleEntry& entry) {
  const CycleTiming& t = entry.timing;
  ++cycles_;
  wakeup_late_.Add(t.wakeup_late_ns);
  receiving_.Add(t.received_ns - t.wakeup_late_ns);
  estimating_.Add(t.estimated_ns - t.received_ns);
  deciding_.Add(t.decided_ns - t.estimated_ns);
  computing_.Add(t.stepped_ns - t.received_ns);
  sending_.Add(t.sent_ns - t.stepped_ns);
  sent_.Add(t.sent_ns);
  if (cycles_ > kWarmUpCycles) {
    counts_.page_faults += t.page_faults;
    counts_.involuntary_switches += t.involuntary_switches;
  }
  if (t.late) {
    ++counts_.late_cycles;
    ++counts_.causes[static_cast<std::size_t>(t.cause) % kLateCauses];
    counts_.last_late_cycle = entry.input.cycle;
    counts_.last_cause = t.cause;
    counts_.last_late_us = static_cast<double>(t.sent_ns) * 1e-3;
  }
  AddFeedback(entry);
  now_ns_ = entry.input.grid_time_ns;
  sent_at_ns_ = now_ns_ + t.sent_ns;
}

void CycleHealth::AddFeedback(const CycleEntry& entry) {
  // The cycle says when feedback is due: not before SYNC runs, and not from drives that are given up.
  const bool due = entry.output.record.stale_cycles != last_stale_cycles_;
  last_stale_cycles_ = entry.output.record.stale_cycles;
  for (std::size_t i = 0; i < axes_.size() && i < entry.output.record.axes.size(); ++i) {
    const AxisFeedback& feedback = entry.output.record.axes[i].feedback;
    if (due && feedback.valid && !feedback.fresh) {
      ++axes_[i].stale_cycles;
      ++stale_;
      stale_axis_ = i;
    }
    if (i >= sources_.size() || cycles_ == 1) continue;
    for (const StampedFrame& f : entry.input.frames)
      if (f.bus == sources_[i].bus && f.frame.id == sources_[i].frame_id && f.stamp_ns > sent_at_ns_)
        axes_[i].response.Add(f.stamp_ns - sent_at_ns_);
  }
}

CycleHealth::Summary CycleHealth::summary() const {
  Summary s = counts_;
  s.wakeup_late = Summarize(wakeup_late_);
  s.receiving = Summarize(receiving_);
  s.estimating = Summarize(estimating_);
  s.deciding = Summarize(deciding_);
  s.computing = Summarize(computing_);
  s.sending = Summarize(sending_);
  s.sent = Summarize(sent_);
  for (const Axis& axis : axes_) s.axes.push_back({axis.stale_cycles, Summarize(axis.response)});
  return s;
}

std::optional<std::string> CycleHealth::TakeMessage() {
  if (said_any_ && now_ns_ - said_ns_ < kQuiet_ns) return std::nullopt;
  std::string text;
  char part[128];
  for (std::size_t c = 1; c < kLateCauses; ++c) {
    const std::uint64_t more = counts_.causes[c] - said_causes_[c];
    if (more == 0) continue;
    std::snprintf(part, sizeof part, "%s%s %llu", text.empty() ? "late cycles by cause: " : ", ",
                  Name(static_cast<LateCause>(c)).data(), static_cast<unsigned long long>(more));
    text += part;
  }
  if (!text.empty()) {
    std::snprintf(part, sizeof part, "; the newest is cycle %llu, %s, sent %.0f us after its grid point",
                  static_cast<unsigned long long>(counts_.last_late_cycle), Name(counts_.last_cause).data(),
                  counts_.last_late_us);
    text += part;
  }
  if (stale_ != said_stale_) {
    if (!text.empty()) text += "; ";
    text += "feedback missing at the grid point " + std::to_string(stale_ - said_stale_) +
            " times, last of axis " + names_[stale_axis_];
  }
  if (text.empty()) return std::nullopt;
  said_causes_ = counts_.causes;
  said_stale_ = stale_;
  said_ns_ = now_ns_;
  said_any_ = true;
  return text;
}

}  // namespace contour
