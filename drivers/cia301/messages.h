#pragma once

#include <cstdint>

#include "core/can_frame.h"

// CiA 301 messages: encode and decode. Values are little-endian on the wire.
namespace contour {

/// Identifiers of the predefined connection set; n is the node.
namespace cob {
inline constexpr std::uint16_t kNmt = 0x000;
inline constexpr std::uint16_t kSync = 0x080;
inline constexpr std::uint16_t kOwnSync = kOwnFrame | kSync;  ///< ours, told when it was on the wire
inline constexpr std::uint16_t kEmergency = 0x080;            ///< + n
inline constexpr std::uint16_t kTpdo1 = 0x180;                ///< + n; TPDO2..4 each 0x100 higher
inline constexpr std::uint16_t kRpdo1 = 0x200;                ///< + n; RPDO2..4 each 0x100 higher
inline constexpr std::uint16_t kSdoReply = 0x580;             ///< + n, server to client
inline constexpr std::uint16_t kSdoRequest = 0x600;           ///< + n, client to server
inline constexpr std::uint16_t kHeartbeat = 0x700;            ///< + n
}  // namespace cob

/// NMT state as a heartbeat carries it.
enum class NmtState : std::uint8_t {
  kBootUp = 0x00,
  kStopped = 0x04,
  kOperational = 0x05,
  kPreOperational = 0x7F,
  kUnknown = 0xFF,  ///< no heartbeat yet; never on the wire
};

enum class NmtCommand : std::uint8_t {
  kStart = 0x01,
  kStop = 0x02,
  kEnterPreOperational = 0x80,
  kResetNode = 0x81,
  kResetCommunication = 0x82,
};

constexpr std::uint16_t GetU16(const CanFrame& f, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(f.data[at] | (f.data[at + 1] << 8));
}
constexpr std::uint32_t GetU32(const CanFrame& f, std::size_t at) noexcept {
  return static_cast<std::uint32_t>(GetU16(f, at)) | (static_cast<std::uint32_t>(GetU16(f, at + 2)) << 16);
}
constexpr void PutU16(CanFrame& f, std::size_t at, std::uint16_t value) noexcept {
  f.data[at] = static_cast<std::uint8_t>(value & 0xFF);
  f.data[at + 1] = static_cast<std::uint8_t>(value >> 8);
}
constexpr void PutU32(CanFrame& f, std::size_t at, std::uint32_t value) noexcept {
  PutU16(f, at, static_cast<std::uint16_t>(value & 0xFFFF));
  PutU16(f, at + 2, static_cast<std::uint16_t>(value >> 16));
}

/// NMT command to one node, or to all with node 0.
constexpr CanFrame NmtFrame(NmtCommand command, std::uint8_t node_id) noexcept {
  CanFrame f{cob::kNmt, 2, {}};
  f.data[0] = static_cast<std::uint8_t>(command);
  f.data[1] = node_id;
  return f;
}

/// SYNC without counter.
constexpr CanFrame SyncFrame() noexcept { return CanFrame{cob::kSync, 0, {}}; }

constexpr CanFrame HeartbeatFrame(std::uint8_t node_id, NmtState state) noexcept {
  CanFrame f{static_cast<std::uint16_t>(cob::kHeartbeat + node_id), 1, {}};
  f.data[0] = static_cast<std::uint8_t>(state);
  return f;
}

/// State in a heartbeat or boot-up message; bit 7 (the toggle bit of node guarding) is ignored.
constexpr NmtState HeartbeatState(const CanFrame& f) noexcept {
  return f.length >= 1 ? static_cast<NmtState>(f.data[0] & 0x7F) : NmtState::kUnknown;
}

/// Emergency object.
struct Emergency {
  std::uint16_t error_code = 0;  ///< 0 says that the error is gone
  std::uint8_t error_register = 0;
};

constexpr CanFrame EmergencyFrame(std::uint8_t node_id, Emergency e) noexcept {
  CanFrame f{static_cast<std::uint16_t>(cob::kEmergency + node_id), 8, {}};
  PutU16(f, 0, e.error_code);
  f.data[2] = e.error_register;
  return f;
}

/// Length 3 or more is expected; the caller checks it.
constexpr Emergency DecodeEmergency(const CanFrame& f) noexcept { return {GetU16(f, 0), f.data[2]}; }

}  // namespace contour
