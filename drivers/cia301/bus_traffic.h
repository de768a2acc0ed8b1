#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>

#include "drivers/cia301/messages.h"

namespace contour {

/// Whose frame it is, by its identifier; what matters more has the higher value.
enum class Traffic : std::uint8_t {
  kOther,    ///< nothing that this machine has to do with
  kMasters,  ///< what only a master sends: NMT, SYNC, set-points, SDO requests; and heartbeats of strangers
  kDrives,   ///< from our drives: feedback, emergencies, SDO replies, heartbeats
};

/// The nodes of our drives on one bus, and what their frames are, by the predefined connection set.
class BusNodes {
 public:
  void Add(int node_id) noexcept { nodes_[static_cast<std::size_t>(node_id) & kNodeMask] = true; }
  [[nodiscard]] bool Has(int node_id) const noexcept {
    return nodes_[static_cast<std::size_t>(node_id) & kNodeMask];
  }
  [[nodiscard]] std::size_t count() const noexcept { return nodes_.count(); }

  [[nodiscard]] Traffic Of(std::uint16_t id) const noexcept {
    const std::size_t node = id & kNodeMask;
    const std::uint16_t function = id & kFunctionMask;
    if (id == cob::kNmt || id == cob::kSync) return Traffic::kMasters;
    if (node == 0 || function == 0) return Traffic::kOther;
    if (!nodes_[node]) return function == cob::kHeartbeat ? Traffic::kMasters : Traffic::kOther;
    // Set-points and SDO requests go to the drives; SYNC apart, everything else of a node comes from it.
    const bool to_the_drive = function == cob::kSdoRequest ||
                              (function >= cob::kRpdo1 && function <= 0x500 && (function & 0x80) == 0);
    return to_the_drive ? Traffic::kMasters : Traffic::kDrives;
  }

  static constexpr std::uint16_t kNodeMask = 0x07F;
  static constexpr std::uint16_t kFunctionMask = 0x780;

 private:
  std::bitset<128> nodes_;
};

}  // namespace contour
