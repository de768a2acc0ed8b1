#pragma once

#include <span>

#include "daemon/rt/bus_state_board.h"
#include "daemon/rt/command_mailbox.h"
#include "daemon/rt/cycle.h"
#include "daemon/rt/io_source.h"
#include "daemon/rt/next_wakeup.h"
#include "drivers/can/frame_bus.h"

namespace contour {

/// What a cycle takes in and gives out, carried between the cycle and its surroundings. The real-time loop,
/// the lock-step loop and virtual time differ only in when they call these.
class CycleRunner {
 public:
  CycleRunner(Cycle& cycle, std::span<FrameBus* const> buses, CommandMailbox& mailbox, IoSource& io)
      : cycle_(cycle), buses_(buses), mailbox_(mailbox), io_(io) {}

  /// Frames of all buses, appended to what is there already; every bus has a share of its own. bus_time_ns is
  /// the grid point: virtual buses move there.
  void Receive(std::int64_t bus_time_ns, ReceivedFrames& frames) noexcept;
  /// All the rest of the input, for this grid point. Virtual and lock-step time take requests only when the
  /// last cycle had settled, so that the number of cycles between two requests does not depend on when they
  /// arrive; a stop always passes.
  void Collect(const GridPoint& grid, std::int64_t now_ns, bool take_requests, CycleInput& in) noexcept;
  /// The output's frames to their buses, a batch each.
  void Send(std::int64_t bus_time_ns, const CycleOutput& out) noexcept;

  /// Whether the auxiliary I/O, or the age of its newest sample, permits something else than `last` did.
  [[nodiscard]] bool IoChanged(const IoInput& last, std::int64_t now_ns) noexcept;

  /// Receive, Collect, Step, Send: one cycle in virtual time.
  void Tick(const GridPoint& grid, bool take_requests, CycleEntry& entry) noexcept;

  [[nodiscard]] const BusStateBoard& bus_states() const noexcept { return bus_states_; }

 private:
  Cycle& cycle_;
  std::span<FrameBus* const> buses_;
  CommandMailbox& mailbox_;
  IoSource& io_;
  std::array<std::uint64_t, kMaxBuses> failures_seen_{};
  std::array<std::uint64_t, kMaxBuses> frames_dropped_{};
  BusStateBoard bus_states_;
};

}  // namespace contour
