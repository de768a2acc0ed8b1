#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/machine_config.h"

// What the frames of a machine ask of its buses, by the analysis of drivers/can/response_time.h.
namespace contour {

/// One message of a bus with its worst-case response times: from its release (at the grid point; for feedback
/// at SYNC) to the end of its transmission. Nothing: it may be delayed for ever.
struct BusMessage {
  std::string name;  ///< "x feedback"
  std::uint16_t id = 0;
  std::uint32_t length = 0;
  double period_ms = 0.0;
  bool cyclic = false;  ///< sent every cycle, and has to be through within it
  std::optional<double> response_us;
  std::optional<double> response_with_emergencies_us;  ///< when each drive sends an emergency message besides
};

struct BusTiming {
  std::string bus;
  double cyclic_load = 0.0;          ///< share of the bus that the frames of every cycle take at worst
  double load = 0.0;                 ///< with heartbeats, SDO and emergencies
  std::vector<BusMessage> messages;  ///< highest priority first
  /// Longest response of a cyclic message; frames may leave this much before the next grid point at the
  /// latest.
  std::optional<double> worst_us;
  std::optional<double> worst_with_emergencies_us;
};

/// Besides the cyclic frames there are SDO transfers (every 2 ms at most), the heartbeats, and for the second
/// figure one emergency message of each drive per inhibit time.
std::vector<BusTiming> BusTimings(const MachineConfig& config);

}  // namespace contour
