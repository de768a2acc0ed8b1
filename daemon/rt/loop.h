#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "daemon/rt/command_mailbox.h"
#include "daemon/rt/cycle.h"
#include "daemon/rt/cycle_runner.h"
#include "daemon/rt/io_source.h"
#include "daemon/rt/late_attribution.h"
#include "daemon/rt/state_snapshots.h"
#include "daemon/rt/telemetry_queue.h"
#include "daemon/rt/thread_accounting.h"
#include "drivers/can/frame_bus.h"

namespace contour {

/// What the loop counts, readable from any thread.
struct LoopCounters {
  std::atomic<std::uint64_t> cycles{0};
  std::atomic<std::uint64_t> late_cycles{0};
  std::atomic<std::uint64_t> skipped_grid_points{0};
  std::atomic<std::int64_t> max_wakeup_late_ns{0};
  std::array<std::atomic<std::uint64_t>, kLateCauses> causes{};  ///< of late cycles, by LateCause
};

/// Everything around the cycle: waits for the grid point, receives, steps, sends, stamps the stages and hands
/// the entry to the telemetry queue. Runs in the calling thread until the cycle says it is finished.
class Loop {
 public:
  struct Config {
    std::int64_t period_ns = 1'000'000;
    std::int64_t send_deadline_ns = 200'000;
    /// Copies of the cycle's state are made here, if anywhere.
    StateSnapshots* snapshots = nullptr;
  };
  Loop(const Config& config, Cycle& cycle, std::span<FrameBus* const> buses, CommandMailbox& mailbox,
       IoSource& io, TelemetryQueue& telemetry);

  /// Real time: absolute wake-ups on a grid that keeps its phase.
  void RunWall() noexcept;
  /// As fast as the feedback comes in; time stands still while there is nothing to do. For emulated machines
  /// only.
  void RunLockstep() noexcept;

  [[nodiscard]] const BusStateBoard& bus_states() const noexcept { return runner_.bus_states(); }
  [[nodiscard]] const LoopCounters& counters() const noexcept { return counters_; }

 private:
  void Finish(CycleEntry& entry, const GridPoint& grid, std::int64_t early_ns,
              ThreadAccounting& accounting) noexcept;
  void WaitForFrames(std::int64_t until_ns) noexcept;
  void WaitForFeedback(const GridPoint& grid, CycleInput& in) noexcept;
  void WaitForWork(const CycleOutput& last, const IoInput& io, const GridPoint& grid,
                   ReceivedFrames& frames) noexcept;
  void KeepRealBuses(CycleOutput& out) const noexcept;

  Config config_;
  Cycle& cycle_;
  std::span<FrameBus* const> buses_;
  CommandMailbox& mailbox_;
  TelemetryQueue& telemetry_;
  CycleRunner runner_;
  LatenessLimits limits_;
  LateCause last_cause_ = LateCause::kNone;
  bool answered_ = true;  ///< in lock-step: the drives answered the SYNC before
  LoopCounters counters_;
};

}  // namespace contour
