#pragma once

#include <cstdint>

#include "core/can_frame.h"

// How long a classic CAN frame with an 11-bit identifier keeps the bus busy.
namespace contour {

inline constexpr std::uint32_t kIntermissionBits = 3;

/// Bits of the longest frame with `length` data bytes, intermission included: 55 + 10 s
/// (Davis, Burns, Bril, Lukkien 2007, eq. 1: 47 + 8 s bits and at worst one stuff bit after each four of 34 +
/// 8 s).
constexpr std::uint32_t WorstFrameBits(std::uint32_t length) noexcept {
  return 47 + 8 * length + (34 + 8 * length - 1) / 4;
}
static_assert(WorstFrameBits(0) == 55 && WorstFrameBits(8) == 135);

/// Bits of this very frame, from start of frame to the end of the intermission, stuff bits counted exactly:
/// bit stuffing runs from the start of frame to the end of the CRC sequence.
constexpr std::uint32_t FrameBits(const CanFrame& frame) noexcept {
  // The bits subject to stuffing, in order, are shifted through the CRC (x^15 + x^14 + x^10 + x^8 + x^7 + x^4
  // + x^3 + 1) and through a run-length counter.
  struct Line {
    std::uint32_t crc = 0;
    std::uint32_t bits = 0;
    std::uint32_t run = 0;
    bool last = true;  // the bus idles recessive, which is not part of a run
    bool started = false;

    constexpr void Level(bool bit) noexcept {
      ++bits;
      run = started && bit == last ? run + 1 : 1;
      started = true;
      last = bit;
      if (run == 5) {  // a bit of the other level follows and starts a run of its own
        ++bits;
        last = !bit;
        run = 1;
      }
    }
    constexpr void Data(std::uint32_t value, int count) noexcept {
      for (int i = count - 1; i >= 0; --i) {
        const bool bit = ((value >> i) & 1u) != 0;
        const bool invert = bit != (((crc >> 14) & 1u) != 0);
        crc = ((crc << 1) ^ (invert ? 0x4599u : 0u)) & 0x7FFFu;
        Level(bit);
      }
    }
  };
  Line line;
  line.Data(0, 1);          // start of frame
  line.Data(frame.id, 11);  // identifier
  line.Data(0, 3);          // RTR, IDE, reserved
  line.Data(frame.length, 4);
  for (std::uint32_t i = 0; i < frame.length && i < 8; ++i) line.Data(frame.data[i], 8);
  const std::uint32_t crc = line.crc;
  for (int i = 14; i >= 0; --i) line.Level(((crc >> i) & 1u) != 0);
  constexpr std::uint32_t kTail =
      1 + 2 + 7 + kIntermissionBits;  // CRC delimiter, ACK, end of frame, intermission
  return line.bits + kTail;
}

/// Duration of `bits` at a bit rate, rounded up to whole nanoseconds.
constexpr std::int64_t BitsToNs(std::uint32_t bits, std::uint32_t bitrate_bit_s) noexcept {
  return (static_cast<std::int64_t>(bits) * 1'000'000'000 + bitrate_bit_s - 1) / bitrate_bit_s;
}

}  // namespace contour
