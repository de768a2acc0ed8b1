#include "tools/plant_emulator/modbus_io_server.h"

#include <modbus.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <memory>
#include <vector>

#include "core/exit_status.h"

namespace contour {
namespace {

constexpr int kPoints = 200;        ///< of each table
constexpr int kPollPeriod_ms = 50;  ///< how soon a stop is noticed
constexpr std::size_t kMostConnections = 16;

struct FreeContext {
  void operator()(modbus_t* m) const noexcept { modbus_free(m); }
};
struct FreeMapping {
  void operator()(modbus_mapping_t* m) const noexcept { modbus_mapping_free(m); }
};

}  // namespace

struct ModbusIoServer::Modbus {
  std::unique_ptr<modbus_t, FreeContext> context;
  std::unique_ptr<modbus_mapping_t, FreeMapping> mapping;
  int listening = -1;
};

ModbusIoServer::ModbusIoServer(const EmulatedIoConfig& config)
    : config_(config), modbus_(std::make_unique<Modbus>()) {
  modbus_->context.reset(modbus_new_tcp(config.host.c_str(), config.port));
  modbus_->mapping.reset(modbus_mapping_new(kPoints, kPoints, kPoints, kPoints));
  const std::string where = "Modbus server on " + config.host + ":" + std::to_string(config.port);
  if (!modbus_->context || !modbus_->mapping) throw EnvironmentError(where + ": " + modbus_strerror(errno));
  modbus_->listening = modbus_tcp_listen(modbus_->context.get(), static_cast<int>(kMostConnections));
  if (modbus_->listening < 0) throw EnvironmentError(where + ": " + modbus_strerror(errno));
  WriteInputs();
  thread_ = std::thread([this] { Serve(); });
}

ModbusIoServer::~ModbusIoServer() {
  stop_.store(true);
  thread_.join();
  ::close(modbus_->listening);
}

void ModbusIoServer::Serve() {
  std::vector<pollfd> sockets{{modbus_->listening, POLLIN, 0}};
  while (!stop_.load()) {
    if (::poll(sockets.data(), sockets.size(), kPollPeriod_ms) <= 0) continue;
    for (std::size_t i = sockets.size(); i-- > 1;) {
      if (sockets[i].revents == 0 || Answer(sockets[i].fd)) continue;
      ::close(sockets[i].fd);
      sockets.erase(sockets.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if ((sockets.front().revents & POLLIN) == 0) continue;
    int listening = modbus_->listening;
    const int accepted = modbus_tcp_accept(modbus_->context.get(), &listening);
    if (accepted < 0) continue;
    if (sockets.size() > kMostConnections) {
      ::close(accepted);
      continue;
    }
    sockets.push_back({accepted, POLLIN, 0});
  }
  for (std::size_t i = 1; i < sockets.size(); ++i) ::close(sockets[i].fd);
}

/// False when the connection has ended.
bool ModbusIoServer::Answer(int socket) {
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> request{};
  modbus_set_socket(modbus_->context.get(), socket);
  const int length = modbus_receive(modbus_->context.get(), request.data());
  if (length < 0) return false;
  if (length == 0) return true;
  WriteInputs();
  const int sent = modbus_reply(modbus_->context.get(), request.data(), length, modbus_->mapping.get());
  ReadCoils();
  return sent >= 0 || errno > MODBUS_ENOBASE;  // an exception reply is an answer too
}

void ModbusIoServer::WriteInputs() {
  modbus_mapping_t& m = *modbus_->mapping;
  shown_emergency_stop_ = open_emergency_stop_.load();
  shown_enable_chain_ = open_enable_chain_.load();
  m.tab_bits[config_.open_emergency_stop_coil] = shown_emergency_stop_ ? 1 : 0;
  m.tab_bits[config_.open_enable_chain_coil] = shown_enable_chain_ ? 1 : 0;
  m.tab_input_bits[config_.emergency_stop_ok_input] = shown_emergency_stop_ ? 0 : 1;
  m.tab_input_bits[config_.enable_chain_ok_input] = shown_enable_chain_ ? 0 : 1;
  const double tenths = std::clamp(std::round(10.0 * temperature_degC_.load()), -32768.0, 32767.0);
  m.tab_input_registers[config_.screw_temperature_register] =
      static_cast<std::uint16_t>(static_cast<std::int16_t>(tenths));
}

/// Takes over what the request wrote. A coil that it left alone is not stored back: another thread may have
/// pressed or released the button since WriteInputs.
void ModbusIoServer::ReadCoils() {
  const modbus_mapping_t& m = *modbus_->mapping;
  const bool emergency_stop = m.tab_bits[config_.open_emergency_stop_coil] != 0;
  const bool enable_chain = m.tab_bits[config_.open_enable_chain_coil] != 0;
  if (emergency_stop != shown_emergency_stop_) open_emergency_stop_.store(emergency_stop);
  if (enable_chain != shown_enable_chain_) open_enable_chain_.store(enable_chain);
  lubrication_.store(m.tab_bits[config_.lubrication_coil] != 0);
}

}  // namespace contour
