#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "drivers/can/bus_node.h"
#include "tools/plant_emulator/emulator_config.h"
#include "tools/plant_emulator/truth.h"

namespace contour {

namespace plant {
class EmulatedAxis;
}

/// Where an emulated axis sits on the bus, and what its drive is unless the emulator's section says
/// otherwise.
struct EmulatedAxisPlacement {
  std::string name;  ///< key in EmulatorConfig::axes
  std::size_t bus = 0;
  std::uint8_t node_id = 1;
  double lead_mm = 5.0;
  double rated_torque_Nm = 0.637;
  double peak_torque_Nm = 1.91;
  double encoder_counts_per_rev = 1048576.0;
  double scale_counts_per_mm = 0.0;      ///< linear scale at the table; 0: none
  std::uint32_t vendor_id = 0x00000C0D;  ///< identity (0x1018) the drive shows
  std::uint32_t product_code = 0x00000402;
  std::uint32_t revision = 0x00010000;
  std::uint32_t serial = 1;
};

enum class EmulatedClock : std::uint8_t {
  kSync,  ///< every SYNC advances the plant by exactly one period, whatever the bus timing
  kWall,  ///< the plant follows the time handed in
};

/// The emulated machine: a ball-screw axis and a CiA 402 drive for each placement. Everything after
/// construction happens inside the BusNode calls: no allocation, no clock read, no system call, so it also
/// runs in the real-time thread on an in-process bus.
///
/// With EmulatedClock::kSync, SYNC n falls on plant time n periods. The drives' watchdogs count plant time,
/// so a slow host trips none. If a drive is enabled (or an axis still moves) and no frame at all came for
/// silence_ms of the time handed in, the plant follows that time until the next SYNC, so that the drives can
/// notice and stop. Time in which nobody listened (a timer that comes late) is no silence.
class EmulatedMachine {
 public:
  /// Throws std::invalid_argument, with the axis and the value named, on a configuration that cannot be
  /// emulated.
  EmulatedMachine(const EmulatorConfig& config, std::span<const EmulatedAxisPlacement> placements,
                  std::uint32_t cycle_us, EmulatedClock clock = EmulatedClock::kSync);
  ~EmulatedMachine();
  EmulatedMachine(EmulatedMachine&&) noexcept;
  EmulatedMachine& operator=(EmulatedMachine&&) noexcept;

  /// All emulated drives of one bus. Lives as long as the machine.
  [[nodiscard]] BusNode& node(std::size_t bus) noexcept;
  [[nodiscard]] std::size_t bus_count() const noexcept;

  /// The newest row; axes in the order of the placements.
  [[nodiscard]] const TruthRow& truth() const noexcept;
  /// `sink` (may be null) sees every row from now on and must outlive the machine or be taken out again.
  void SetTruthSink(TruthSink* sink) noexcept;

 private:
  class Impl;
  // What breaks drives is part of no program that anybody runs a machine with:
  friend class DriveFaults;    // of the tests
  friend class MachineTamper;  // of contour_faults
  [[nodiscard]] plant::EmulatedAxis& axis(std::size_t axis) noexcept;

  std::unique_ptr<Impl> impl_;
};

}  // namespace contour
