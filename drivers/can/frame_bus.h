#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/can_frame.h"

namespace contour {

/// By the error counters of a CAN controller: below 96, above, and above 127; then comes bus-off.
enum class ControllerErrors : std::uint8_t { kActive, kWarning, kPassive };

constexpr std::string_view Name(ControllerErrors e) noexcept {
  return e == ControllerErrors::kPassive ? "passive" : e == ControllerErrors::kWarning ? "warning" : "active";
}

/// State of a bus as the last calls saw it. Counters never go back.
struct BusState {
  bool up = false;
  bool bus_off = false;
  // As error frames say; a virtual bus has none. Small: the cycle copies all of it.
  ControllerErrors errors = ControllerErrors::kActive;
  std::uint8_t transmit_errors = 0;  ///< counted by the controller, where the kernel tells
  std::uint8_t receive_errors = 0;
  std::uint16_t bus_offs = 0;
  std::uint64_t frames_received = 0;
  std::uint64_t frames_sent = 0;
  std::uint64_t send_failures = 0;  ///< frames not accepted (ENOBUFS, ENETDOWN, ...)
  std::uint64_t error_frames = 0;
  std::uint64_t receive_overflows = 0;  ///< frames lost before we saw them
  std::uint64_t frames_dropped =
      0;  ///< seen, but beyond the bus's share of a cycle; counted by the cycle's runner
};

/// The master's end of one CAN bus. Never blocks, never throws, never allocates after construction.
class FrameBus {
 public:
  virtual ~FrameBus() = default;

  /// Takes the frames that have arrived up to `now_ns` (virtual buses) or up to now (real ones), oldest
  /// first, at most frames.size(); returns how many. Fills stamp_ns; leaves `bus` to the caller.
  virtual std::size_t Receive(std::int64_t now_ns, std::span<StampedFrame> frames) noexcept = 0;

  /// Hands a batch over in order at `now_ns`; returns how many were accepted. The rest is lost and counted.
  virtual std::size_t Send(std::int64_t now_ns, std::span<const CanFrame> frames) noexcept = 0;

  [[nodiscard]] virtual BusState State() const noexcept = 0;

  /// For poll(): readable when frames wait; -1 for a bus inside the process.
  [[nodiscard]] virtual int fd() const noexcept { return -1; }
};

}  // namespace contour
