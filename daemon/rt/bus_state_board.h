#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "core/cycle_input.h"
#include "drivers/can/frame_bus.h"

namespace contour {

/// The buses' states as the real-time thread last saw them, readable from any thread. Each number is whole;
/// they may be from different cycles.
class BusStateBoard {
 public:
  void Publish(std::size_t bus, const BusState& state) noexcept {
    Entry& e = entries_[bus];
    constexpr auto kRelaxed = std::memory_order_relaxed;
    e.up.store(state.up, kRelaxed);
    e.bus_off.store(state.bus_off, kRelaxed);
    e.frames_received.store(state.frames_received, kRelaxed);
    e.frames_sent.store(state.frames_sent, kRelaxed);
    e.send_failures.store(state.send_failures, kRelaxed);
    e.receive_overflows.store(state.receive_overflows, kRelaxed);
    e.frames_dropped.store(state.frames_dropped, kRelaxed);
    if (e.error_frames.load(kRelaxed) == state.error_frames) return;
    e.errors.store(state.errors, kRelaxed);
    e.transmit_errors.store(state.transmit_errors, kRelaxed);
    e.receive_errors.store(state.receive_errors, kRelaxed);
    e.bus_offs.store(state.bus_offs, kRelaxed);
    e.error_frames.store(state.error_frames, kRelaxed);
  }
  [[nodiscard]] BusState Read(std::size_t bus) const noexcept {
    const Entry& e = entries_[bus];
    BusState out;
    constexpr auto kRelaxed = std::memory_order_relaxed;
    out.up = e.up.load(kRelaxed);
    out.bus_off = e.bus_off.load(kRelaxed);
    out.frames_received = e.frames_received.load(kRelaxed);
    out.frames_sent = e.frames_sent.load(kRelaxed);
    out.send_failures = e.send_failures.load(kRelaxed);
    out.error_frames = e.error_frames.load(kRelaxed);
    out.receive_overflows = e.receive_overflows.load(kRelaxed);
    out.frames_dropped = e.frames_dropped.load(kRelaxed);
    out.errors = e.errors.load(kRelaxed);
    out.transmit_errors = e.transmit_errors.load(kRelaxed);
    out.receive_errors = e.receive_errors.load(kRelaxed);
    out.bus_offs = e.bus_offs.load(kRelaxed);
    return out;
  }

 private:
  struct Entry {
    std::atomic<bool> up{false};
    std::atomic<bool> bus_off{false};
    std::atomic<std::uint64_t> frames_received{0};
    std::atomic<std::uint64_t> frames_sent{0};
    std::atomic<std::uint64_t> send_failures{0};
    std::atomic<std::uint64_t> error_frames{0};
    std::atomic<std::uint64_t> receive_overflows{0};
    std::atomic<std::uint64_t> frames_dropped{0};
    std::atomic<ControllerErrors> errors{ControllerErrors::kActive};
    std::atomic<std::uint8_t> transmit_errors{0};
    std::atomic<std::uint8_t> receive_errors{0};
    std::atomic<std::uint16_t> bus_offs{0};
  };
  std::array<Entry, kMaxBuses> entries_;
};

}  // namespace contour
