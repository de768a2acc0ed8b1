#pragma once

#include <cstdint>

#include "core/cycle_input.h"
#include "drivers/can/frame_bus.h"
#include "drivers/cia301/bus_traffic.h"

namespace contour {

/// Frames taken from one bus in one call at the most: what a bus at 1 Mbit/s carries in more than 20 ms.
inline constexpr std::size_t kMostFramesTaken = 512;

/// Places of the cycle's input that each bus has for itself.
constexpr std::size_t ShareOfBus(std::size_t buses) noexcept {
  return buses == 0 ? kMaxFramesPerCycle : kMaxFramesPerCycle / buses;
}

/// Empties bus number `bus` into `frames`, of which it may fill `share` places in all, those of earlier calls
/// included. Nothing stays behind to be taken for news a cycle later. A bus that says more than its share is
/// cut down to what matters: frames of nobody in particular go first, then the older ones of an identifier
/// that comes again and again, so that the newest of every identifier of our drives stays. What stays is in
/// order of arrival. Gives the number of frames that were dropped.
std::size_t TakeShare(FrameBus& from, std::uint8_t bus, std::size_t share, const BusNodes& nodes,
                      std::int64_t bus_time_ns, ReceivedFrames& frames) noexcept;

}  // namespace contour
