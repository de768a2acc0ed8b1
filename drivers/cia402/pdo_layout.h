#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/can_frame.h"
#include "drivers/cia301/messages.h"
#include "drivers/cia402/drive_config.h"

// Which bytes of which PDO carry which quantity. One place for the mapping that is written to the drive and
// for the encoding that relies on it.
namespace contour {

/// An entry of a PDO mapping (0x1600.., 0x1A00..): index, sub-index, length in bits.
constexpr std::uint32_t MappingEntry(std::uint16_t index, std::uint8_t sub, std::uint8_t bits) noexcept {
  return (static_cast<std::uint32_t>(index) << 16) | (static_cast<std::uint32_t>(sub) << 8) | bits;
}

/// CST: controlword 0..1, target torque 2..3.
inline constexpr std::array kRpdoTorque{MappingEntry(0x6040, 0, 16), MappingEntry(0x6071, 0, 16)};
/// CSP: controlword 0..1, target position 2..5.
inline constexpr std::array kRpdoPosition{MappingEntry(0x6040, 0, 16), MappingEntry(0x607A, 0, 32)};
/// CSP with torque offset: the same, torque offset 6..7.
inline constexpr std::array kRpdoPositionTorque{MappingEntry(0x6040, 0, 16), MappingEntry(0x607A, 0, 32),
                                                MappingEntry(0x60B2, 0, 16)};
/// Statusword 0..1, position actual 2..5, torque actual 6..7.
inline constexpr std::array kTpdoFeedback{MappingEntry(0x6041, 0, 16), MappingEntry(0x6064, 0, 32),
                                          MappingEntry(0x6077, 0, 16)};
/// Second encoder 0..3.
inline constexpr std::array kTpdoScale{MappingEntry(0x60E4, 1, 32)};

inline constexpr std::uint8_t kFeedbackLength = 8;
inline constexpr std::uint8_t kScaleLength = 4;

constexpr std::span<const std::uint32_t> RpdoMapping(const DriveConfig& drive) noexcept {
  if (drive.mode == DriveMode::kCst) return kRpdoTorque;
  if (drive.csp_torque_offset) return kRpdoPositionTorque;
  return kRpdoPosition;
}

/// Bytes of a PDO with this mapping.
constexpr std::uint8_t PdoLength(std::span<const std::uint32_t> mapping) noexcept {
  std::uint32_t bits = 0;
  for (const std::uint32_t entry : mapping) bits += entry & 0xFF;
  return static_cast<std::uint8_t>(bits / 8);
}

struct RawFeedback {
  std::uint16_t statusword = 0;
  std::int32_t position_counts = 0;
  std::int16_t torque_per_mille = 0;
};

/// TPDO1; the caller has checked the length.
constexpr RawFeedback DecodeFeedback(const CanFrame& f) noexcept {
  return {GetU16(f, 0), static_cast<std::int32_t>(GetU32(f, 2)), static_cast<std::int16_t>(GetU16(f, 6))};
}

/// TPDO2 of a drive that reads a linear scale; the caller has checked the length.
constexpr std::int32_t DecodeScale(const CanFrame& f) noexcept {
  return static_cast<std::int32_t>(GetU32(f, 0));
}

constexpr CanFrame EncodeTorqueSetpoint(std::uint8_t node_id, std::uint16_t controlword,
                                        std::int16_t torque_per_mille) noexcept {
  CanFrame f{static_cast<std::uint16_t>(cob::kRpdo1 + node_id), 4, {}};
  PutU16(f, 0, controlword);
  PutU16(f, 2, static_cast<std::uint16_t>(torque_per_mille));
  return f;
}

constexpr CanFrame EncodePositionSetpoint(std::uint8_t node_id, std::uint16_t controlword,
                                          std::int32_t position_counts, bool with_torque,
                                          std::int16_t torque_per_mille) noexcept {
  CanFrame f{
      static_cast<std::uint16_t>(cob::kRpdo1 + node_id), static_cast<std::uint8_t>(with_torque ? 8 : 6), {}};
  PutU16(f, 0, controlword);
  PutU32(f, 2, static_cast<std::uint32_t>(position_counts));
  if (with_torque) PutU16(f, 6, static_cast<std::uint16_t>(torque_per_mille));
  return f;
}

}  // namespace contour
