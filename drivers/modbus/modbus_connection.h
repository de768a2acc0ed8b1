#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

typedef struct _modbus modbus_t;  // NOLINT(bugprone-reserved-identifier): libmodbus's name

namespace contour {

/// One TCP connection to a Modbus server, over libmodbus. Every call waits at most the time-out. A call that
/// fails gives nothing (or false) and leaves the cause in error(); unless the server answered with an
/// exception, the connection is closed then, so that a late reply is never taken for the next one.
class ModbusConnection {
 public:
  ModbusConnection(const std::string& host, int port, int unit_id, int timeout_ms);
  ~ModbusConnection();

  bool Connect();
  void Close();
  [[nodiscard]] bool connected() const noexcept { return connected_; }

  std::optional<bool> ReadDiscreteInput(int address);
  std::optional<std::int16_t> ReadInputRegister(int address);
  bool WriteCoil(int address, bool on);
  bool WriteRegister(int address, std::uint16_t value);

  [[nodiscard]] const std::string& error() const noexcept { return error_; }

 private:
  bool Check(int result, const std::string& what);

  struct Free {
    void operator()(modbus_t* context) const noexcept;
  };
  std::string server_;
  std::unique_ptr<modbus_t, Free> context_;
  bool connected_ = false;
  std::string error_;
};

}  // namespace contour
