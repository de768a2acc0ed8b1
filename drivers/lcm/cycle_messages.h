#pragma once

#include <contour_lcm/cycle_entry.hpp>
#include <contour_lcm/faults.hpp>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/cycle_record.h"
#include "drivers/lcm/crc32c.h"

// Core's plain structs to and from the LCM types. Both directions go through one list of fields, so that
// nothing can be written and not read; doubles keep their bits.
namespace contour {

void ToMessage(const CycleEntry& entry, contour_lcm::cycle_entry& message);

/// False when the message holds more axes, frames, buses or path points than this program can.
bool FromMessage(const contour_lcm::cycle_entry& message, CycleEntry& entry);

/// Only what is about faults, for looking at.
contour_lcm::faults FaultsOf(const CycleRecord& record);

/// The encoded bytes of any LCM type.
template <class Message>
std::string Encode(const Message& message) {
  std::string bytes(static_cast<std::size_t>(message.getEncodedSize()), '\0');
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

/// False when the bytes are not such a message.
template <class Message>
bool Decode(std::string_view bytes, Message& message) {
  return message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) == static_cast<int>(bytes.size());
}

/// Where a type that begins with `int32_t crc32c` has its checksum: behind the 8 bytes of the type's
/// fingerprint.
inline constexpr std::size_t kChecksumBegin = 8;
inline constexpr std::size_t kChecksumEnd = 12;

/// Encodes a type that begins with `int32_t crc32c` and fills the checksum in.
template <class Message>
std::string EncodeChecked(const Message& message) {
  std::string bytes = Encode(message);
  const std::uint32_t crc = Crc32c(std::string_view(bytes).substr(kChecksumEnd));
  for (std::size_t i = 0; i < 4; ++i)
    bytes[kChecksumBegin + i] = static_cast<char>((crc >> (24 - 8 * i)) & 0xFFu);
  return bytes;
}

/// False when the bytes are not such a message or the checksum does not match.
template <class Message>
bool DecodeChecked(std::string_view bytes, Message& message) {
  if (bytes.size() < kChecksumEnd) return false;
  std::uint32_t crc = 0;
  for (std::size_t i = kChecksumBegin; i < kChecksumEnd; ++i)
    crc = (crc << 8) | static_cast<unsigned char>(bytes[i]);
  return crc == Crc32c(bytes.substr(kChecksumEnd)) && Decode(bytes, message);
}

}  // namespace contour
