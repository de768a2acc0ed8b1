#pragma once

#include <modbus.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

namespace contour::test {

/// A Modbus TCP server on a free port of 127.0.0.1, with 16 of everything; serves one client at a time.
class ModbusServer {
 public:
  ModbusServer();
  ~ModbusServer();
  ModbusServer(const ModbusServer&) = delete;
  ModbusServer& operator=(const ModbusServer&) = delete;

  void Start();
  /// Closes the connection and the port; Start() opens the same port again.
  void Stop();
  /// While mute, requests are taken and not answered.
  void SetMute(bool mute) { mute_ = mute; }

  void SetInput(int address, bool closed);
  void SetRegister(int address, std::int16_t value);
  bool Coil(int address) const;
  int Holding(int address) const;
  /// As somebody else would write it.
  void SetCoil(int address, bool on);
  int port() const { return port_; }

 private:
  void Serve();

  modbus_mapping_t* mapping_;
  int port_ = 0;
  std::atomic<bool> mute_{false};
  std::atomic<bool> stop_{true};
  mutable std::mutex mutex_;  // guards the mapping
  modbus_t* context_ = nullptr;
  int listener_ = -1;
  std::thread thread_;
};

}  // namespace contour::test
