#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "tools/plant_emulator/emulator_config.h"

namespace contour {

/// The emulated machine's inputs and outputs as a Modbus TCP server in a thread of its own. Discrete inputs
/// say that the emergency-stop circuit and the enable chain are closed; an input register gives the screw's
/// temperature in tenths of a degree; a coil takes the lubrication. Two more coils stand for the buttons:
/// writing 1 opens the emergency stop or the enable chain, 0 closes it (EmulatedIoConfig has the addresses).
class ModbusIoServer {
 public:
  /// Listens at once. Throws EnvironmentError when the address cannot be used.
  explicit ModbusIoServer(const EmulatedIoConfig& config);
  ~ModbusIoServer();
  ModbusIoServer(const ModbusIoServer&) = delete;
  ModbusIoServer& operator=(const ModbusIoServer&) = delete;

  void SetTemperature_degC(double temperature) noexcept { temperature_degC_.store(temperature); }
  /// The buttons, from inside the process.
  void OpenEmergencyStop(bool open) noexcept { open_emergency_stop_.store(open); }
  void OpenEnableChain(bool open) noexcept { open_enable_chain_.store(open); }
  [[nodiscard]] bool lubrication() const noexcept { return lubrication_.load(); }
  [[nodiscard]] int port() const noexcept { return config_.port; }

 private:
  struct Modbus;
  void Serve();
  bool Answer(int socket);
  void WriteInputs();
  void ReadCoils();

  EmulatedIoConfig config_;
  std::unique_ptr<Modbus> modbus_;
  std::atomic<double> temperature_degC_{20.0};
  std::atomic<bool> open_emergency_stop_{false};
  std::atomic<bool> open_enable_chain_{false};
  std::atomic<bool> lubrication_{false};
  std::atomic<bool> stop_{false};
  bool shown_emergency_stop_ = false;  ///< as WriteInputs last showed it; serving thread only
  bool shown_enable_chain_ = false;    ///< same
  std::thread thread_;
};

}  // namespace contour
