#pragma once

#include <array>
#include <cstdint>

namespace contour {

/// Part of the identifier of a frame that we sent ourselves and that comes back to say when it was on the
/// wire. No identifier of 11 bits has it.
inline constexpr std::uint16_t kOwnFrame = 0x8000;

/// A classic CAN data frame with an 11-bit identifier.
struct CanFrame {
  std::uint16_t id = 0;
  std::uint8_t length = 0;
  std::array<std::uint8_t, 8> data{};

  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

/// A frame with the bus it belongs to (index into the machine's buses) and, when received, its time stamp.
struct StampedFrame {
  CanFrame frame;
  std::uint8_t bus = 0;
  std::int64_t stamp_ns = 0;  ///< kernel time stamp (real bus) or virtual time (loopback); end of frame
};

}  // namespace contour
