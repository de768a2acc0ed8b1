#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

// Worst-case response times on a CAN bus with priorities by identifier, after Davis, Burns, Bril, Lukkien,
// "Controller Area Network (CAN) schedulability analysis: refuted, revisited and revised", Real-Time Systems
// 35 (2007). Pure functions; not for the real-time side.
namespace contour {

/// A message, sent by one node: lower identifiers win.
struct CanMessage {
  std::string name;
  std::uint16_t id = 0;
  std::uint32_t length = 0;    ///< data bytes
  std::int64_t period_ns = 0;  ///< shortest time between two of them
  std::int64_t jitter_ns = 0;  ///< of the queueing, after the event that releases it
};

/// Longest time C of the message on the wire, stuff bits and intermission included.
[[nodiscard]] std::int64_t TransmissionTime_ns(const CanMessage& message,
                                               std::uint32_t bitrate_bit_s) noexcept;

/// Share of the bus that the messages take at worst; 1 is all of it.
[[nodiscard]] double Load(std::span<const CanMessage> messages, std::uint32_t bitrate_bit_s) noexcept;

/// Worst-case response time R of messages[which]: from its release to the end of its transmission (section 4,
/// eqs. 10 to 16: all instances within the busy period are looked at). Nothing when the busy period does not
/// end, that is when the messages that can delay it ask for more than the whole bus.
[[nodiscard]] std::optional<std::int64_t> ResponseTime_ns(std::span<const CanMessage> messages,
                                                          std::size_t which, std::uint32_t bitrate_bit_s);

}  // namespace contour
