#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/machine_config.h"
#include "daemon/interface_lock.h"
#include "daemon/lanes/slow_lane.h"
#include "daemon/truth_relay.h"
#include "drivers/can/frame_bus.h"
#include "tools/plant_emulator/emulated_machine.h"
#include "tools/plant_emulator/modbus_io_server.h"

namespace contour {

/// The buses of a machine: SocketCAN interfaces, locked against another contourd of this computer, or, when
/// all are `loopback`, in-process buses with the emulated machine on them.
class MachineBuses {
 public:
  /// `emulator` is needed for loopback only. Throws ConfigError (loopback mixed with real buses, no emulator
  /// section), EnvironmentError or BusUnavailable.
  MachineBuses(const MachineConfig& machine, const std::optional<EmulatorConfig>& emulator,
               const std::string& truth_file);
  ~MachineBuses();

  [[nodiscard]] const std::vector<FrameBus*>& all() const { return pointers_; }
  [[nodiscard]] bool loopback() const { return emulated_ != nullptr; }
  /// Every bus is in-process or virtual CAN.
  [[nodiscard]] bool all_virtual() const { return all_virtual_; }
  /// Has what the emulated machine has told written; not for the real-time thread.
  void DrainTruth();
  /// The last of it. False when the file did not take it by then.
  bool FinishTruth(std::chrono::steady_clock::time_point deadline);

 private:
  std::unique_ptr<EmulatedMachine> emulated_;
  std::unique_ptr<ModbusIoServer> io_server_;
  std::shared_ptr<TruthRelay> relay_;
  std::unique_ptr<SlowLane> truth_lane_;
  std::uint64_t reported_lost_ = 0;
  bool reported_failure_ = false;
  std::vector<std::unique_ptr<InterfaceLock>> locks_;
  std::vector<std::unique_ptr<FrameBus>> buses_;
  std::vector<FrameBus*> pointers_;
  bool all_virtual_ = true;
};

}  // namespace contour
