#include "tests/drivers/modbus/modbus_server.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

namespace contour::test {
namespace {

int PortOf(int socket) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  // The one cast that the socket interface wants.
  getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

bool Readable(int socket) {
  pollfd p{socket, POLLIN, 0};
  return poll(&p, 1, 10) > 0;
}

}  // namespace

ModbusServer::ModbusServer() : mapping_(modbus_mapping_new(16, 16, 16, 16)) { Start(); }

ModbusServer::~ModbusServer() {
  Stop();
  modbus_mapping_free(mapping_);
}

void ModbusServer::Start() {
  context_ = modbus_new_tcp("127.0.0.1", port_);
  listener_ = modbus_tcp_listen(context_, 1);
  if (listener_ < 0) throw std::runtime_error("no port for the Modbus server");
  port_ = PortOf(listener_);
  stop_ = false;
  thread_ = std::thread(&ModbusServer::Serve, this);
}

void ModbusServer::Stop() {
  if (!thread_.joinable()) return;
  stop_ = true;
  thread_.join();
  close(listener_);
  modbus_free(context_);
}

void ModbusServer::Serve() {
  std::uint8_t request[MODBUS_TCP_MAX_ADU_LENGTH];
  while (!stop_) {
    if (!Readable(listener_)) continue;
    if (modbus_tcp_accept(context_, &listener_) < 0) continue;
    bool alive = true;
    while (alive && !stop_) {
      if (!Readable(modbus_get_socket(context_))) continue;
      const int size = modbus_receive(context_, request);
      alive = size >= 0;
      if (size <= 0 || mute_) continue;
      const std::lock_guard lock(mutex_);
      modbus_reply(context_, request, size, mapping_);
    }
    modbus_close(context_);
  }
}

void ModbusServer::SetInput(int address, bool closed) {
  const std::lock_guard lock(mutex_);
  mapping_->tab_input_bits[address] = closed ? 1 : 0;
}

void ModbusServer::SetRegister(int address, std::int16_t value) {
  const std::lock_guard lock(mutex_);
  mapping_->tab_input_registers[address] = static_cast<std::uint16_t>(value);
}

int ModbusServer::Holding(int address) const {
  const std::lock_guard lock(mutex_);
  return mapping_->tab_registers[address];
}

void ModbusServer::SetCoil(int address, bool on) {
  const std::lock_guard lock(mutex_);
  mapping_->tab_bits[address] = on ? 1 : 0;
}

bool ModbusServer::Coil(int address) const {
  const std::lock_guard lock(mutex_);
  return mapping_->tab_bits[address] != 0;
}

}  // namespace contour::test
