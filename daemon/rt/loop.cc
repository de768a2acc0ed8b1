#include "daemon/rt/loop.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "drivers/can/clock_ns.h"
#include "drivers/can/socketcan_bus.h"

namespace contour {
namespace {

void SleepUntil(std::int64_t time_ns) noexcept {
  const timespec t{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

/// Takes the time where the cycle passes.
class StageClock final : public StageSink {
 public:
  void Passed(CycleStage stage) noexcept override {
    (stage == CycleStage::kEstimated ? estimated_ns : decided_ns) = ClockNow_ns();
  }
  std::int64_t estimated_ns = 0;
  std::int64_t decided_ns = 0;
};

/// How often lock-step looks for feedback that no descriptor announces, for path points, for requests.
constexpr std::int64_t kLockstepPoll_ns = 50'000;
constexpr std::int64_t kLockstepStarvedPoll_ns = 200'000;
constexpr std::int64_t kLockstepIdlePoll_ns = 2'000'000;
/// Heartbeats while lock-step time stands still.
constexpr std::int64_t kLockstepHeartbeat_ns = 20'000'000;
/// Feedback that has not come after this long of wall time will not come.
constexpr std::int64_t kLockstepFeedbackTimeout_ns = 2'000'000'000;
/// A look that comes later counts for no more than this: a host that held us up held the drives up, too.
constexpr std::int64_t kLockstepLook_ns = kLockstepFeedbackTimeout_ns / 8;

/// Of frames that say the same, the latest: while time stands still, repetition is no news.
void KeepLatestOfEach(ReceivedFrames& frames) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool repeated = std::any_of(frames.begin() + i + 1, frames.end(), [&](const StampedFrame& later) {
      return later.bus == frames[i].bus && later.frame == frames[i].frame;
    });
    if (!repeated) frames[kept++] = frames[i];
  }
  frames.resize(kept);
}

}  // namespace

Loop::Loop(const Config& config, Cycle& cycle, std::span<FrameBus* const> buses, CommandMailbox& mailbox,
           IoSource& io, TelemetryQueue& telemetry)
    : config_(config),
      cycle_(cycle),
      buses_(buses),
      mailbox_(mailbox),
      telemetry_(telemetry),
      runner_(cycle, buses, mailbox, io) {}

void Loop::RunWall() noexcept {
  ThreadAccounting accounting;
  StageClock stages;
  limits_ = {config_.send_deadline_ns, ThrottleTime_ns()};
  // The grid begins one period from now, so that the first wake-up is an ordinary one.
  const std::int64_t origin = ClockNow_ns();
  GridPoint grid{0, origin, 0};
  std::int64_t last_sent = origin;
  bool finished = false;
  while (!finished) {
    const std::int64_t asleep = ClockNow_ns();
    grid = NextWakeup(origin, config_.period_ns, grid.index, asleep);
    // The kernel would give up the processor for a time that has gone by, too.
    const std::int64_t early_ns = grid.time_ns - asleep;
    if (early_ns > 0) SleepUntil(grid.time_ns);
    const std::int64_t woken = ClockNow_ns();
    CycleEntry& entry = *telemetry_.Reserve();
    entry.input.frames.clear();
    runner_.Receive(grid.time_ns, entry.input.frames);
    runner_.Collect(grid, woken, true, entry.input);
    const std::int64_t received = ClockNow_ns();
    cycle_.Act(entry.input, entry.output, &stages);
    const std::int64_t stepped = ClockNow_ns();
    runner_.Send(grid.time_ns, entry.output);
    finished = entry.output.finished;
    const std::int64_t sent = ClockNow_ns();
    cycle_.Report(entry.input, entry.output);
    CycleTiming& timing = entry.timing;
    timing = {};
    timing.wakeup_late_ns = woken - grid.time_ns;
    timing.received_ns = received - grid.time_ns;
    timing.estimated_ns = stages.estimated_ns - grid.time_ns;
    timing.decided_ns = stages.decided_ns - grid.time_ns;
    timing.stepped_ns = stepped - grid.time_ns;
    timing.sent_ns = sent - grid.time_ns;
    timing.after_send_ns = asleep - last_sent;
    last_sent = sent;
    Finish(entry, grid, early_ns, accounting);
  }
}

// All that is not needed to send the frames comes after them.
void Loop::Finish(CycleEntry& entry, const GridPoint& grid, std::int64_t early_ns,
                  ThreadAccounting& accounting) noexcept {
  CycleTiming& timing = entry.timing;
  timing.skipped_grid_points = grid.skipped;
  timing.late = timing.sent_ns > config_.send_deadline_ns || grid.skipped != 0;
  const ThreadCounts counts = accounting.Read();
  timing.page_faults = counts.page_faults;
  timing.involuntary_switches = counts.involuntary_switches;
  const bool slept = early_ns > 0 && counts.voluntary_switches != 0;
  timing.voluntary_switches = counts.voluntary_switches - (slept ? 1U : 0U);
  timing.run_delay_ns = accounting.RunDelay_ns();
  const std::int64_t waited_ns =
      accounting.OffCpu_ns() - timing.run_delay_ns - std::max<std::int64_t>(early_ns, 0);
  if (timing.late) {
    timing.cause =
        FindLateCause(timing, {last_cause_, std::max<std::int64_t>(-early_ns, 0), waited_ns}, limits_);
    counters_.late_cycles.fetch_add(1, std::memory_order_relaxed);
    counters_.causes[static_cast<std::size_t>(timing.cause)].fetch_add(1, std::memory_order_relaxed);
  }
  last_cause_ = timing.cause;
  counters_.cycles.fetch_add(1, std::memory_order_relaxed);
  counters_.skipped_grid_points.fetch_add(grid.skipped, std::memory_order_relaxed);
  if (timing.wakeup_late_ns > counters_.max_wakeup_late_ns.load(std::memory_order_relaxed))
    counters_.max_wakeup_late_ns.store(timing.wakeup_late_ns, std::memory_order_relaxed);
  const std::uint64_t cycle = entry.input.cycle;
  cycle_.TellLate(timing.late);
  telemetry_.Publish();
  if (config_.snapshots != nullptr) config_.snapshots->TakeWhenDue(cycle_, cycle);
}

void Loop::RunLockstep() noexcept {
  GridPoint grid;
  bool finished = false;
  CycleOutput last;
  IoInput io;
  ReceivedFrames frames;
  while (!finished) {
    grid = {grid.index + 1, static_cast<std::int64_t>(grid.index + 1) * config_.period_ns, 0};
    frames.clear();
    WaitForWork(last, io, grid, frames);
    CycleEntry& entry = *telemetry_.Reserve();
    entry.input.frames = frames;
    WaitForFeedback(grid, entry.input);
    runner_.Collect(grid, ClockNow_ns(), !last.settling, entry.input);
    cycle_.Step(entry.input, entry.output);
    runner_.Send(grid.time_ns, entry.output);
    finished = entry.output.finished;
    io = entry.input.io;
    last.finished = finished;
    last.quiescent = entry.output.quiescent;
    last.settling = entry.output.settling;
    entry.timing = {};
    counters_.cycles.fetch_add(1, std::memory_order_relaxed);
    telemetry_.Publish();
    if (config_.snapshots != nullptr) config_.snapshots->TakeWhenDue(cycle_, grid.index);
  }
}

void Loop::WaitForFeedback(const GridPoint& grid, CycleInput& in) noexcept {
  std::int64_t waited = 0, looked = ClockNow_ns();
  // Before the drives answer SYNC there is nothing to keep step with but the period itself. A drive that has
  // let its time go by is not waited for as long again until it answers.
  const bool expected = cycle_.ExpectsFeedback();
  const std::int64_t limit = expected && answered_ ? kLockstepFeedbackTimeout_ns : config_.period_ns;
  for (;;) {
    runner_.Receive(grid.time_ns, in.frames);
    answered_ = !expected || cycle_.FeedbackComplete(in);
    if (expected && answered_) return;
    const std::int64_t now = ClockNow_ns();
    waited += std::min(now - looked, kLockstepLook_ns);
    looked = now;
    if (waited >= limit || in.frames.full()) return;
    WaitForFrames(now + std::min(limit - waited, kLockstepLook_ns));
  }
}

void Loop::WaitForFrames(std::int64_t until_ns) noexcept {
  FixedVector<int, kMaxBuses> fds;
  for (const FrameBus* bus : buses_)
    if (bus->fd() >= 0) fds.push_back(bus->fd());
  if (fds.empty()) {
    SleepUntil(ClockNow_ns() + kLockstepPoll_ns);
  } else {
    static_cast<void>(WaitReadable(std::span(fds.data(), fds.size()), until_ns));
  }
}

// On an in-process bus time stands still with ours: nobody there misses us, and what we sent would never
// leave the queue.
void Loop::KeepRealBuses(CycleOutput& out) const noexcept {
  FixedVector<StampedFrame, kMaxFramesSentPerCycle> real;
  for (const StampedFrame& f : out.frames)
    if (buses_[f.bus]->fd() >= 0) real.push_back(f);
  out.frames = real;
}

void Loop::WaitForWork(const CycleOutput& last, const IoInput& io, const GridPoint& grid,
                       ReceivedFrames& frames) noexcept {
  std::int64_t next_heartbeat = ClockNow_ns();
  for (;;) {
    const bool idle = last.quiescent && !mailbox_.request_waiting() && !runner_.IoChanged(io, ClockNow_ns());
    const bool starved = cycle_.PathRoom() != 0 && mailbox_.more_path_to_come() &&
                         mailbox_.path_points_waiting() < kMaxPathPointsPerCycle;
    // Nothing waits for real time here, so nothing needs to be dropped either.
    const bool crowded = telemetry_.size() + 1 >= telemetry_.capacity();
    if (!idle && !starved && !crowded && !mailbox_.path_planning()) return;
    // The drives' hearts go on beating: left in the sockets, they would fill the input of the next cycles and
    // push the feedback out of it.
    runner_.Receive(grid.time_ns, frames);
    KeepLatestOfEach(frames);
    if (cycle_.MustSee(frames) && !crowded) return;
    const std::int64_t now = ClockNow_ns();
    if (now >= next_heartbeat) {
      next_heartbeat = now + kLockstepHeartbeat_ns;
      CycleOutput alive;
      cycle_.EncodeHeartbeat(alive);
      KeepRealBuses(alive);
      runner_.Send(0, alive);
    }
    SleepUntil(now + (idle ? kLockstepIdlePoll_ns : kLockstepStarvedPoll_ns));
  }
}

}  // namespace contour
