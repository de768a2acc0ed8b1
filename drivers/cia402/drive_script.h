#pragma once

#include <cstdint>
#include <vector>

#include "drivers/cia301/bring_up.h"
#include "drivers/cia402/drive_config.h"

namespace contour {

/// Interpolation period as 0x60C2 holds it: value times ten to the power of exponent seconds.
struct InterpolationPeriod {
  std::uint8_t value = 1;
  std::int8_t exponent = -3;
};

/// Throws std::invalid_argument when 0x60C2 cannot hold the period (a value of 1 to 255 and a power of ten).
[[nodiscard]] InterpolationPeriod ToInterpolationPeriod(std::uint32_t cycle_us);

/// Cycles in a time, rounded up, at least 1.
[[nodiscard]] std::uint64_t CyclesOf(double time_ms, std::uint32_t cycle_us) noexcept;

/// Cycles between two heartbeats of the master, so that a drive that notices its silence within `notice_ms`
/// misses two before it acts. At least 1.
[[nodiscard]] std::uint64_t MasterHeartbeatCycles(double notice_ms, std::uint32_t cycle_us) noexcept;

/// How one drive is brought up: its deadlines and the SDO script that identifies, compares and configures it.
/// `torque_limit_Nm` goes to the drive as 0x6072. With `reads_first` only what differs is written. Throws
/// std::invalid_argument on nonsense.
[[nodiscard]] BringUpNode DriveScript(const DriveConfig& drive, std::uint8_t axis, double torque_limit_Nm,
                                      int master_node_id, std::uint32_t cycle_us, bool reads_first);

}  // namespace contour
