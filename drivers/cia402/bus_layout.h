#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/can/response_time.h"
#include "drivers/cia402/drive_config.h"

// Whether the frames of a machine fit its bus. Used by `contour check`; not for the real-time side.
namespace contour {

/// A drive on the bus looked at.
struct BusDrive {
  std::string axis;
  DriveConfig drive;
};

/// Worst case with some number of emergency messages in the same cycle.
struct BusResponse {
  std::optional<double> tpdo_us;  ///< longest response of a TPDO; nothing when it has no bound
  std::optional<double> rpdo_us;  ///< longest response of an RPDO
  /// Period minus the longest RPDO response; negative or nothing when it misses.
  std::optional<double> computing_us;
};

struct BusAnalysis {
  double load = 0.0;        ///< of SYNC and PDOs alone
  double total_load = 0.0;  ///< of all messages: emergencies, SDO and heartbeats too
  BusResponse quiet;        ///< no emergency message
  BusResponse one_emergency;
  BusResponse all_emergencies;  ///< one of each drive
  /// Longest time from handing a cycle's batch over to the end of its SYNC, and to the last TPDO it calls
  /// for.
  double batch_us = 0.0;
  double feedback_us = 0.0;
  /// Feedback arrives at the latest this long after the grid point, when the batch is handed over at the send
  /// deadline.
  double feedback_latest_us = 0.0;
  /// Emergency messages within one cycle with which feedback is still in time; -1 when it is late without
  /// any.
  int emergencies_carried = -1;
  bool holds = false;   ///< the timing of a cycle holds on this bus
  std::string verdict;  ///< one sentence
};

/// The messages of a bus: SYNC, RPDO1, TPDO1 (and TPDO2 with a linear scale) per drive every cycle; one
/// emergency message per drive for the first `emergencies` drives; SDO every 2 ms; the heartbeats of drives
/// and master at the rates that are configured.
[[nodiscard]] std::vector<CanMessage> BusMessages(std::span<const BusDrive> drives, const BusConfig& bus,
                                                  std::uint32_t cycle_us, std::size_t emergencies);

/// Checks the scheme of a cycle: RPDOs and SYNC k handed over at most `send_deadline_us` after grid point k;
/// all TPDOs latched at SYNC k on the wire before grid point k + 1.
[[nodiscard]] BusAnalysis AnalyseBus(std::span<const BusDrive> drives, const BusConfig& bus,
                                     std::uint32_t cycle_us, double send_deadline_us);

}  // namespace contour
