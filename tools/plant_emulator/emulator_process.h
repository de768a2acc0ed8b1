#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/plant_emulator/emulated_machine.h"

namespace contour {

struct EmulatorProcessOptions {
  std::vector<std::string> interfaces;  ///< SocketCAN interface of each bus, in the order of the buses
  std::vector<std::string> axis_names;
  EmulatedClock clock = EmulatedClock::kSync;
  std::optional<std::string> truth_path;
  std::optional<EmulatedIoConfig> io;
};

/// Runs an emulated machine on SocketCAN buses until `stop` becomes true: frames in, frames out, the
/// machine's timers by CLOCK_MONOTONIC, its truth to a file, its inputs and outputs as a Modbus server. Calls
/// `ready` once everything listens. Throws what opening buses, file or server throws; a bus that goes down
/// later is waited for.
void RunEmulatorProcess(EmulatedMachine& machine, const EmulatorProcessOptions& options,
                        const std::atomic<bool>& stop, void (*ready)(const EmulatorProcessOptions&));

}  // namespace contour
