#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/cycle_input.h"
#include "drivers/cia301/master_watch.h"

namespace contour {

/// Who belongs to one bus: our master and our drives.
struct BusParties {
  std::string name;
  std::uint8_t master_node_id = 0;
  std::vector<std::uint8_t> nodes;
};

/// Watches for others on the buses who are no second master: a service tool that asks our drives by SDO, and
/// devices that are none of ours. They are counted and told, nothing more.
class ForeignTraffic {
 public:
  struct OnBus {
    std::uint64_t sdo_requests = 0;   ///< to our drives, not by us
    std::vector<std::uint8_t> nodes;  ///< that sent a heartbeat and are neither drive nor master of ours
  };

  void Watch(std::vector<BusParties> buses);
  void Add(const CycleInput& in);
  [[nodiscard]] std::vector<OnBus> summary() const;
  /// What is new since the last time, a line for people; nothing when that was just said.
  std::optional<std::string> TakeMessage();

 private:
  struct Bus {
    std::string name;
    MasterWatch watch;
    std::bitset<128> ours;
    std::bitset<128> others;
    std::uint64_t sdo_requests = 0;
    std::uint64_t sdo_requests_told = 0;
    std::size_t others_told = 0;
    std::uint64_t quiet_cycles = 0;  ///< since the last line on SDO requests
  };
  [[nodiscard]] static std::vector<std::uint8_t> Nodes(const std::bitset<128>& set);

  std::vector<Bus> buses_;
};

}  // namespace contour
