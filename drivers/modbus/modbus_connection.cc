#include "drivers/modbus/modbus_connection.h"

#include <modbus.h>

#include <cerrno>
#include <stdexcept>

namespace contour {

void ModbusConnection::Free::operator()(modbus_t* context) const noexcept { modbus_free(context); }

ModbusConnection::ModbusConnection(const std::string& host, int port, int unit_id, int timeout_ms)
    : server_(host + ":" + std::to_string(port)),
      context_(modbus_new_tcp_pi(host.c_str(), std::to_string(port).c_str())) {
  if (context_ == nullptr)
    throw std::invalid_argument("Modbus server " + server_ + ": " + modbus_strerror(errno));
  modbus_set_slave(context_.get(), unit_id);
  const auto seconds = static_cast<std::uint32_t>(timeout_ms / 1000);
  const auto microseconds = static_cast<std::uint32_t>(timeout_ms % 1000) * 1000;
  modbus_set_response_timeout(context_.get(), seconds, microseconds);
  // 0: the bytes of a reply, too, must all be there within the response time-out.
  modbus_set_byte_timeout(context_.get(), 0, 0);
}

ModbusConnection::~ModbusConnection() { Close(); }

bool ModbusConnection::Connect() {
  Close();
  if (!Check(modbus_connect(context_.get()), "connect")) return false;
  connected_ = true;
  return true;
}

void ModbusConnection::Close() {
  if (connected_) modbus_close(context_.get());
  connected_ = false;
}

std::optional<bool> ModbusConnection::ReadDiscreteInput(int address) {
  std::uint8_t value = 0;
  const std::string what = "read discrete input " + std::to_string(address);
  if (!Check(modbus_read_input_bits(context_.get(), address, 1, &value), what)) return std::nullopt;
  return value != 0;
}

std::optional<std::int16_t> ModbusConnection::ReadInputRegister(int address) {
  std::uint16_t value = 0;
  const std::string what = "read input register " + std::to_string(address);
  if (!Check(modbus_read_input_registers(context_.get(), address, 1, &value), what)) return std::nullopt;
  return static_cast<std::int16_t>(value);
}

bool ModbusConnection::WriteCoil(int address, bool on) {
  return Check(modbus_write_bit(context_.get(), address, on ? 1 : 0),
               "write coil " + std::to_string(address));
}

bool ModbusConnection::WriteRegister(int address, std::uint16_t value) {
  return Check(modbus_write_register(context_.get(), address, value),
               "write register " + std::to_string(address));
}

bool ModbusConnection::Check(int result, const std::string& what) {
  if (result != -1) return true;
  const int cause = errno;
  error_ = "Modbus server " + server_ + ": " + what + ": " + modbus_strerror(cause);
  const bool exception_reply = cause > MODBUS_ENOBASE && cause < EMBBADCRC;
  if (!exception_reply) Close();
  return false;
}

}  // namespace contour
