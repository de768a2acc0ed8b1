#include "daemon/rt/cycle_runner.h"

#include <algorithm>
#include <array>

#include "daemon/rt/bus_share.h"

namespace contour {

void CycleRunner::Receive(std::int64_t bus_time_ns, ReceivedFrames& frames) noexcept {
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    const std::size_t share = ShareOfBus(buses_.size());
    frames_dropped_[b] += TakeShare(*buses_[b], static_cast<std::uint8_t>(b), share, cycle_.bus_nodes()[b],
                                    bus_time_ns, frames);
  }
}

void CycleRunner::Collect(const GridPoint& grid, std::int64_t now_ns, bool take_requests,
                          CycleInput& in) noexcept {
  in.cycle = grid.index;
  in.grid_time_ns = grid.time_ns;
  in.buses.resize(buses_.size());
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    BusState state = buses_[b]->State();
    state.frames_dropped = frames_dropped_[b];
    bus_states_.Publish(b, state);
    in.buses[b] = {state.up, state.bus_off,
                   static_cast<std::uint32_t>(state.send_failures - failures_seen_[b])};
    failures_seen_[b] = state.send_failures;
  }
  in.request = mailbox_.TakeRequest(take_requests);
  if (in.request.kind == RequestKind::kTune) {
    ContourController* next = mailbox_.TakeController();
    if (next == nullptr || !cycle_.TakeController(*next)) in.request.program_id = kNothingChanged;
  }
  in.io = io_.Read(now_ns);
  mailbox_.TellProgress(cycle_.Progress());
  in.path.clear();
  const std::size_t room = std::min(in.path.capacity(), cycle_.PathRoom());
  while (in.path.size() < room) {
    PathPoint point;
    if (!mailbox_.TakePathPoint(point)) break;
    in.path.push_back(point);
  }
}

void CycleRunner::Send(std::int64_t bus_time_ns, const CycleOutput& out) noexcept {
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    std::array<CanFrame, kMaxFramesSentPerCycle> batch;
    std::size_t count = 0;
    for (const StampedFrame& f : out.frames)
      if (f.bus == b) batch[count++] = f.frame;
    if (count != 0) buses_[b]->Send(bus_time_ns, {batch.data(), count});
  }
}

bool CycleRunner::IoChanged(const IoInput& last, std::int64_t now_ns) noexcept {
  const IoInput now = io_.Read(now_ns);
  return now.fresh != last.fresh || now.emergency_stop_ok != last.emergency_stop_ok ||
         now.enable_chain_ok != last.enable_chain_ok;
}

void CycleRunner::Tick(const GridPoint& grid, bool take_requests, CycleEntry& entry) noexcept {
  entry.input.frames.clear();
  Receive(grid.time_ns, entry.input.frames);
  Collect(grid, grid.time_ns, take_requests, entry.input);
  cycle_.Step(entry.input, entry.output);
  Send(grid.time_ns, entry.output);
  entry.timing = {};
}

}  // namespace contour
