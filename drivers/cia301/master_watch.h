#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/can_frame.h"
#include "drivers/cia301/messages.h"

namespace contour {

/// What only a master sends on a bus of drives.
enum class MasterSign : std::uint8_t {
  kNone,
  kNmt,
  kSync,
  kSetpoint,    ///< RPDO of one of our drives
  kSdoRequest,  ///< to one of our drives: a master's, or a service tool's
  kHeartbeat,   ///< under our master's own node number
};

constexpr std::string_view Name(MasterSign sign) noexcept {
  switch (sign) {
    case MasterSign::kNone:
      return "nothing";
    case MasterSign::kNmt:
      return "NMT command";
    case MasterSign::kSync:
      return "SYNC";
    case MasterSign::kSetpoint:
      return "set-points";
    case MasterSign::kSdoRequest:
      return "SDO request";
    case MasterSign::kHeartbeat:
      return "heartbeat under our master's node number";
  }
  return "unknown";
}

/// Says of a frame that we received whether another master sent it. What we send ourselves does not come back
/// to us; what drives answer (TPDO, heartbeat, boot-up, emergency, SDO reply) is no sign.
class MasterWatch {
 public:
  MasterWatch() = default;
  explicit MasterWatch(std::uint8_t master_node_id) : master_node_id_(master_node_id) {}

  /// One of our drives.
  void Add(std::uint8_t node_id) noexcept { ours_[node_id & kNodeMask] = true; }

  [[nodiscard]] MasterSign SignOf(const CanFrame& frame) const noexcept {
    const std::uint16_t node = frame.id & kNodeMask;
    switch (frame.id & ~kNodeMask) {
      case cob::kNmt:
        return node == 0 ? MasterSign::kNmt : MasterSign::kNone;
      case cob::kSync:
        return node == 0 ? MasterSign::kSync : MasterSign::kNone;
      case cob::kRpdo1:
      case cob::kRpdo1 + 0x100:
      case cob::kRpdo1 + 0x200:
      case cob::kRpdo1 + 0x300:
        return ours_[node] ? MasterSign::kSetpoint : MasterSign::kNone;
      case cob::kSdoRequest:
        return ours_[node] ? MasterSign::kSdoRequest : MasterSign::kNone;
      case cob::kHeartbeat:
        return node != 0 && node == master_node_id_ ? MasterSign::kHeartbeat : MasterSign::kNone;
      default:
        return MasterSign::kNone;
    }
  }

 private:
  static constexpr std::uint16_t kNodeMask = 0x7F;
  std::uint8_t master_node_id_ = 0;  ///< 0: none
  std::array<bool, 128> ours_{};
};

/// A service tool beside us reads and writes objects; everything else is a second master in any case.
constexpr bool IsSecondMaster(MasterSign sign) noexcept {
  return sign != MasterSign::kNone && sign != MasterSign::kSdoRequest;
}

}  // namespace contour
