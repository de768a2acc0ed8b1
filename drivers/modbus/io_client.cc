#include "drivers/modbus/io_client.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "drivers/modbus/modbus_connection.h"

namespace contour {
namespace {

constexpr int kFirstRetry_ms = 50;
constexpr int kLastRetry_ms = 2000;
/// A server that the host held up has answered the second one.
constexpr unsigned kFailuresInLockstep = 2;

std::int64_t MonotonicNow_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

IoClient::IoClient(const ModbusConfig& config)
    : config_(config),
      connection_(
          std::make_unique<ModbusConnection>(config.host, config.port, config.unit_id, config.timeout_ms)) {
  if (config_.outputs.lubrication) lubrication_.emplace(*config_.outputs.lubrication);
  if (config_.outputs.program)
    outputs_.emplace(std::chrono::duration_cast<OutputWriter::Clock::duration>(
        std::chrono::duration<double>(config_.outputs.program->silence_s)));
  stats_.configured = true;
}

IoClient::~IoClient() { Stop(); }

void IoClient::Start() {
  if (!thread_.joinable()) thread_ = std::thread(&IoClient::Work, this);
}

void IoClient::Stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

IoInput IoClient::Read(std::int64_t now_ns) const noexcept {
  const IoSample sample = snapshot_.Load();
  return From(sample, now_ns - sample.time_ns <= std::int64_t{config_.timeout_ms} * 1'000'000);
}

IoInput IoClient::ReadInLockstep() const noexcept {
  return From(snapshot_.Load(), failed_polls_.load(std::memory_order_acquire) < kFailuresInLockstep);
}

IoInput IoClient::From(const IoSample& sample, bool fresh) const noexcept {
  IoInput io;
  io.configured = true;
  io.fresh = sample.taken && fresh;
  io.emergency_stop_ok = io.fresh && sample.emergency_stop_closed;
  io.enable_chain_ok = io.fresh && sample.enable_chain_closed;
  io.screw_temperature_degC = std::numeric_limits<double>::quiet_NaN();
  if (sample.taken && config_.inputs.screw_temperature) {
    const TemperatureInputConfig& sensor = *config_.inputs.screw_temperature;
    io.screw_temperature_degC = sensor.offset_degC + sensor.degC_per_count * sample.temperature_counts;
  }
  return io;
}

void IoClient::ReportMotion(double travel_m, double moving_s) noexcept {
  travel_m_.store(travel_m, std::memory_order_relaxed);
  moving_s_.store(moving_s, std::memory_order_relaxed);
}

IoStats IoClient::stats() const {
  const std::lock_guard lock(mutex_);
  return stats_;
}

void IoClient::Work() {
  int retry_ms = kFirstRetry_ms;
  bool stop = false;
  while (!stop) {
    const bool read = (connection_->connected() || Connect()) && Poll();
    failed_polls_.store(read ? 0 : failed_polls_.load(std::memory_order_relaxed) + 1,
                        std::memory_order_release);
    const bool ok = read && DriveOutputs();
    stop = WaitForStop(ok ? config_.poll_ms : retry_ms);
    retry_ms = ok ? kFirstRetry_ms : std::min(2 * retry_ms, kLastRetry_ms);
  }
  if (coil_.value_or(false) && connection_->connected())
    connection_->WriteCoil(config_.outputs.lubrication->coil, false);
  if (outputs_) outputs_->Release(*connection_);
  connection_->Close();
}

bool IoClient::Connect() {
  coil_.reset();
  if (outputs_) outputs_->Forget();
  if (!connection_->Connect()) {
    Fail(connection_->error());
    return false;
  }
  const std::lock_guard lock(mutex_);
  stats_.connected = true;
  ++stats_.connections;
  return true;
}

bool IoClient::Poll() {
  IoSample sample;
  sample.time_ns = MonotonicNow_ns();
  sample.taken = true;
  // An input that is not wired takes no permission away.
  const auto closed = [&](const std::optional<int>& address) {
    return address ? connection_->ReadDiscreteInput(*address) : std::optional<bool>(true);
  };
  const auto emergency_stop = closed(config_.inputs.emergency_stop);
  const auto enable_chain = emergency_stop ? closed(config_.inputs.enable_chain) : std::nullopt;
  const auto temperature = !enable_chain ? std::nullopt
                           : config_.inputs.screw_temperature
                               ? connection_->ReadInputRegister(config_.inputs.screw_temperature->address)
                               : std::optional<std::int16_t>(std::int16_t{0});
  if (!temperature) {
    Fail(connection_->error());
    return false;
  }
  sample.emergency_stop_closed = *emergency_stop;
  sample.enable_chain_closed = *enable_chain;
  sample.temperature_counts = *temperature;
  snapshot_.Store(sample);
  const std::lock_guard lock(mutex_);
  ++stats_.polls;
  return true;
}

// Reading goes on at its pace when only an output is refused; it is tried again at the next poll.
bool IoClient::DriveOutputs() {
  if (outputs_ && !outputs_->Write(*connection_)) {
    Fail(connection_->error());
    if (!connection_->connected()) return false;
  }
  return Lubricate();
}

bool IoClient::Lubricate() {
  if (!lubrication_) return true;
  const bool on = lubrication_->Update(travel_m_.load(std::memory_order_relaxed),
                                       moving_s_.load(std::memory_order_relaxed), MonotonicNow_ns());
  {
    const std::lock_guard lock(mutex_);
    stats_.lubrication_pulses = lubrication_->pulses();
  }
  if (coil_ == on) return true;
  if (!connection_->WriteCoil(config_.outputs.lubrication->coil, on)) {
    Fail(connection_->error());
    return connection_->connected();
  }
  coil_ = on;
  return true;
}

void IoClient::Fail(const std::string& what) {
  const std::lock_guard lock(mutex_);
  stats_.connected = connection_->connected();
  ++stats_.failures;
  stats_.last_error = what;
}

bool IoClient::WaitForStop(int milliseconds) {
  std::unique_lock lock(mutex_);
  return wake_.wait_for(lock, std::chrono::milliseconds(milliseconds), [this] { return stop_; });
}

}  // namespace contour
